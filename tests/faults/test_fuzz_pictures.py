"""Damaged pictures of radiance, a short run of `fuzz_pictures`; RSIBR_FAULT_CASES asks for a longer one."""

import json
import os
import subprocess
import sys

CASES = int(os.environ.get("RSIBR_FAULT_CASES", 400))


def test_damage_ends_in_a_picture_or_a_sentence() -> None:
    seed = os.environ.get("RSIBR_FAULT_SEED", "0")
    command = [
        sys.executable,
        "-m",
        "rsibr.tests.faults.fuzz_pictures",
        "--seed",
        seed,
        "--cases",
        str(CASES),
    ]
    # In a process of its own, which a crash would end
    run = subprocess.run(command, capture_output=True, text=True, check=False)
    assert run.returncode == 0, run.stderr
    ends = json.loads(run.stdout.splitlines()[-1])
    assert ends == {"cases": CASES, "refused": ends["refused"], "done": ends["done"]}
    assert min(ends["done"], ends["refused"]) > CASES / 10
