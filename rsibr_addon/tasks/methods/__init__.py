"""The ways of making map sets, one a kind."""
