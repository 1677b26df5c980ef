"""Put previews side by side: contact_sheet.py OUT.png COLUMNS PREVIEW.exr ..."""

import sys
from pathlib import Path

from rsibr.rsibr_addon.files.pictures import read_exr
from rsibr.rsibr_addon.host.pictures import save_png
from rsibr.rsibr_addon.tasks.contact_sheet import contact_sheet

output, columns, *previews = sys.argv[1:]
save_png(Path(output), contact_sheet([read_exr(preview) for preview in previews], int(columns)))
