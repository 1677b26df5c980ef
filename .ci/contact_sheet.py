"""Put previews side by side, some stops brighter: contact_sheet.py OUT.png COLUMNS STOPS PREVIEW.exr ..."""

import sys
from pathlib import Path

from rsibr.rsibr_addon.files.pictures import read_exr
from rsibr.rsibr_addon.host.pictures import save_png
from rsibr.rsibr_addon.tasks.compare.contact_sheet import contact_sheet

output, columns, stops, *previews = sys.argv[1:]
sheet = contact_sheet([read_exr(preview) for preview in previews], int(columns))
sheet[..., :3] *= 2.0 ** float(stops)
save_png(Path(output), sheet)
