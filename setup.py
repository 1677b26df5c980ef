"""What pyproject.toml cannot say: the root is the package `rsibr`, whatever the checkout is called."""

from setuptools import find_packages, setup

INSIDE = find_packages(include=["operators", "operators.*", "rsibr_addon", "rsibr_addon.*"])

setup(
    script_name="setup.py",  # and so no module of the package
    package_dir={"rsibr": "."},
    packages=["rsibr", *(f"rsibr.{name}" for name in INSIDE)],
)
