"""Damaged photographs and measurements, a short run of `fuzz_photographs`."""

import json
import os
import subprocess
import sys

import pytest

CASES = int(os.environ.get("RSIBR_FAULT_CASES", 400))


@pytest.mark.slow
def test_damage_ends_in_a_result_or_a_sentence() -> None:
    seed = os.environ.get("RSIBR_FAULT_SEED", "0")
    command = [sys.executable, "-m", "rsibr.tests.faults.fuzz_photographs", "--seed", seed]
    # In a process of its own, which a crash would end
    run = subprocess.run([*command, "--cases", str(CASES)], capture_output=True, text=True, check=False)
    assert (run.returncode, run.stderr) == (0, "")
    ends = json.loads(run.stdout)
    assert ends == {"cases": CASES, "refused": ends["refused"], "done": ends["done"]}
    # Some damage does no harm, other does
    assert min(ends["done"], ends["refused"]) > 0.1 * CASES
