"""The table of docs/accuracy.md, of comparisons of radiance views: accuracy_table.py FOLDER FOLDER ..."""

import json
import sys
from pathlib import Path


def main() -> None:
    """Print a row for each material, environment and number of captured views."""
    found = [json.loads((Path(folder) / "comparison.json").read_text()) for folder in sys.argv[1:]]
    columns = list(dict.fromkeys((e["mode"], e["warping"]) for each in found for e in each["errors"]))
    head = ["material", "environment", "views", *(", ".join(column) for column in columns), "noise"]
    rows = [head, ["---"] * 3 + ["---:"] * (len(columns) + 1)]
    for each in found:
        pooled = {(e["captured_views"], e["mode"], e["warping"]): e["pooled"] for e in each["errors"]}
        for views in dict.fromkeys(way[0] for way in pooled):
            numbers = [*(pooled[views, *column] for column in columns), each["reference_noise"]]
            told = [each["material"], each["environment"], str(views)]
            rows.append([*told, *(f"{number:.3f}" for number in numbers)])
    print("".join(f"| {' | '.join(row)} |\n" for row in rows), end="")


if __name__ == "__main__":
    main()
