"""Code of other processors for OpenBLAS and numpy, which choose theirs by the processor and can be told."""

from numpy._core._multiarray_umath import __cpu_dispatch__, __cpu_features__

DISPATCHED = " ".join(name for name in __cpu_dispatch__ if __cpu_features__.get(name))
OLDEST = {
    "OPENBLAS_CORETYPE": "Prescott",
    "NPY_DISABLE_CPU_FEATURES": DISPATCHED,
    "OPENBLAS_NUM_THREADS": "1",
}
NEWER = {"OPENBLAS_CORETYPE": "Haswell", "OPENBLAS_NUM_THREADS": "2"}

SETTINGS = {"as it is": {}, "oldest": OLDEST} | ({"newer": NEWER} if __cpu_features__.get("AVX2") else {})
"""Name -> variables of the environment of a process."""
