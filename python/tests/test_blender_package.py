"""The package of the extension for Blender: what it is made of. Blender is not needed."""

import re
import runpy
from pathlib import Path

import pytest

import nearmiss

FOLDER = Path(__file__).parent.parent / "blender"
MANIFEST = (FOLDER / "blender_manifest.toml").read_text(encoding="utf-8")
pack = runpy.run_path(str(FOLDER / "pack.py"))["pack"]


def test_the_manifest_has_the_version_of_nearmiss():
    assert re.search(r'^version = "(.*)"$', MANIFEST, re.M)[1] == nearmiss.__version__


def test_a_wheel_of_another_version_is_refused(tmp_path):
    wheel = tmp_path / "nearmiss-9.9.9-cp310-abi3-linux_x86_64.whl"
    wheel.touch()
    with pytest.raises(SystemExit, match=re.escape(f"got {wheel.name}; build it")):
        pack([wheel], tmp_path)
    assert list(tmp_path.iterdir()) == [wheel]
