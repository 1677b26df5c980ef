"""What the fuzzers share: readers are fed with damage, and each case ends in a result or in a sentence.

All else is told, with what makes it again: the numbers of the seed and of the case.
"""

import argparse
import contextlib
import faulthandler
import io
import json
import math
import os
import random
import resource
import sys
import tempfile
import traceback
import warnings
from collections import Counter
from collections.abc import Callable, Iterator
from pathlib import Path

from rsibr.rsibr_addon.core.errors import RsibrError, RsibrWarning

Reader = Callable[[Path], object]
Cases = Callable[[Path, random.Random], Iterator[tuple[Path, Reader]]]

ENDS = "done", "refused"


def run_cases(
    cases: Cases,
    seconds: float,
    megabytes: float = math.inf,
    refusals: tuple[type[Exception], ...] = (RsibrError,),
) -> int:
    """Run cases; 1 where one has ended otherwise than it may.

    Parameters
    ----------
    cases : callable
        A folder to write to, and a source of chance, to damaged files without end and what is to read them.
    seconds : float
        That no case takes.
    megabytes : float
        That no case takes beyond those before.
    refusals : tuple of type
        Errors that a case may end in, with one sentence.
    """
    parser = argparse.ArgumentParser()
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--cases", type=int, default=1000)
    parser.add_argument("--keep", type=Path, help="a folder for the inputs that failed")
    parser.add_argument("--only", type=int, help="the one case to run")
    arguments = parser.parse_args()
    ends: Counter[str] = Counter()
    # A reader that takes too long may have put standard error away meanwhile
    with os.fdopen(os.dup(2), "w") as told, tempfile.TemporaryDirectory() as name:
        made = cases(Path(name), random.Random(arguments.seed))
        for number, (path, read) in zip(range(arguments.cases), made, strict=False):
            if arguments.only not in (None, number):
                continue
            before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
            faulthandler.dump_traceback_later(seconds, exit=True, file=told)
            end = _end(path, read, refusals)
            faulthandler.cancel_dump_traceback_later()
            grown = (resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - before) / 1024
            if grown > megabytes:
                end = f"takes {grown:.0f} MB more"
            ends[end if end in ENDS else "failed"] += 1
            if end not in ENDS:
                what = f"seed {arguments.seed}, case {number}, {path.name}, {read.__name__}: {end}"
                print(what, file=sys.stderr, flush=True)
                if arguments.keep:
                    kept = arguments.keep / f"{arguments.seed}-{number}-{read.__name__}{path.suffix}"
                    kept.write_bytes(path.read_bytes())
    print(json.dumps({"cases": arguments.cases, **ends}))
    return 1 if ends["failed"] else 0


def _end(path: Path, read: Reader, refusals: tuple[type[Exception], ...]) -> str:
    try:
        with warnings.catch_warnings(record=True) as caught, contextlib.redirect_stdout(io.StringIO()):
            warnings.simplefilter("error")
            warnings.simplefilter("always", RsibrWarning)
            read(path)
        said = [str(warning.message) for warning in caught]
        end = "done"
    except refusals as error:
        said, end = [str(error)], "refused"
    except Exception:
        return traceback.format_exc()
    bad = [sentence for sentence in said if "\n" in sentence or not 0 < len(sentence) < 2000]
    return f"says {bad[0]!r}" if bad else end
