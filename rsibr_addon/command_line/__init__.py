"""The command line `rsibr`: one file per command."""
