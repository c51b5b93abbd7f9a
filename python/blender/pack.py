"""Make the file that Blender installs: the extension, its manifest and wheels of nearmiss.

    python pack.py WHEEL... --out FOLDER

Prints the path of the file.
"""

import argparse
import re
import zipfile
from pathlib import Path

HERE = Path(__file__).parent


def pack(wheels, folder):
    """Write the file of the extension and return its path."""
    manifest = (HERE / "blender_manifest.toml").read_text(encoding="utf-8")
    version = re.search(r'^version = "(.*)"$', manifest, re.M)[1]
    for wheel in wheels:
        if not re.fullmatch(rf"nearmiss-{re.escape(version)}-.*\.whl", wheel.name):
            raise SystemExit(
                f"the wheel must be of nearmiss {version}, got {wheel.name}; "
                "build it from the checkout of this script"
            )
    names = ", ".join(f'"./wheels/{wheel.name}"' for wheel in wheels)
    manifest = manifest.replace("wheels = []", f"wheels = [{names}]")
    path = folder / f"nearmiss-blender-{version}.zip"
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as packed:
        packed.writestr("blender_manifest.toml", manifest)
        packed.write(HERE / "__init__.py", "__init__.py")
        for wheel in wheels:
            packed.write(wheel, f"wheels/{wheel.name}")
    return path


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description="Make the file that Blender installs.")
    parser.add_argument("wheels", type=Path, nargs="+", help="wheels of nearmiss")
    parser.add_argument("--out", type=Path, default=Path(), help="folder of the file [.]")
    arguments = parser.parse_args()
    print(pack(arguments.wheels, arguments.out))
