"""The content of each kind of map set, read from its file: a module for each kind.

`to_map_set` takes such content and its `Origin`, and gives the `MapSet` that holds both. `from_map_set` gives
the content that a `MapSet` of the kind holds; it takes its file's path for messages, and raises a MapSetError
where the parts do not make up such content. Docstrings of these functions tell only what differs.
"""
