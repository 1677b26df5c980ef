"""The modules of the extension; see docs/architecture.md for who may know whom."""
