"""The kinds of map sets on the GPU."""
