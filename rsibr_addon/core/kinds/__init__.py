"""The kinds of map sets: what each holds, how it is made, and how it is shaded."""
