"""Print how far previews are from the first of them: picture_errors.py EXACT.exr PREVIEW.exr ..."""

import sys
from pathlib import Path

from rsibr.rsibr_addon.core.metrics import relative_rmse, unpremultiplied
from rsibr.rsibr_addon.files.pictures import read_exr

exact, *others = sys.argv[1:]
true = read_exr(exact)
for other in others:
    error = relative_rmse(unpremultiplied(read_exr(other)), unpremultiplied(true), true[..., 3])
    print(f"{Path(other).stem}: {error:.3f}")
