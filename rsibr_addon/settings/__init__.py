"""What a user says of the work: one dataclass of options for each method and command."""
