"""What a user asks for, from start to end.

A task is a generator of `Progress` that ends with its result: see `core.progress.Steps`. What it writes is
called `output`; an existing file is replaced only with `force`, and an OutputFileError tells where it cannot
be written. Docstrings of tasks tell only what differs.
"""
