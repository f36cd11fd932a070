"""Builds the wheel of the package: for pip, or by itself (`python3 wheel_backend.py FOLDER`). Same sources, same bytes."""

import base64
import hashlib
import os
import sys
import zipfile
from typing import Any, Dict, Optional

NAME, VERSION = "fleetproof", "0.1.0"
HERE = os.path.dirname(os.path.abspath(__file__))
METADATA = f"""Metadata-Version: 2.1
Name: {NAME}
Version: {VERSION}
Summary: control software for fleetproof in Python
Requires-Python: >=3.9
"""
WHEEL = """Wheel-Version: 1.0
Generator: wheel_backend
Root-Is-Purelib: true
Tag: py3-none-any
"""


def build_wheel(wheel_directory: str, config_settings: Any = None, metadata_directory: Optional[str] = None) -> str:
    information = f"{NAME}-{VERSION}.dist-info"
    files: Dict[str, bytes] = {}
    for name in sorted(os.listdir(os.path.join(HERE, NAME))):
        if name.endswith((".py", ".typed")):
            with open(os.path.join(HERE, NAME, name), "rb") as source:
                files[f"{NAME}/{name}"] = source.read()
    files[f"{information}/METADATA"] = METADATA.encode()
    files[f"{information}/WHEEL"] = WHEEL.encode()
    record = ""
    for name, content in files.items():
        digest = base64.urlsafe_b64encode(hashlib.sha256(content).digest()).rstrip(b"=").decode()
        record += f"{name},sha256={digest},{len(content)}\n"
    files[f"{information}/RECORD"] = (record + f"{information}/RECORD,,\n").encode()
    wheel = f"{NAME}-{VERSION}-py3-none-any.whl"
    with zipfile.ZipFile(os.path.join(wheel_directory, wheel), "w", zipfile.ZIP_DEFLATED) as archive:
        for name, content in files.items():
            entry = zipfile.ZipInfo(name, (2020, 1, 1, 0, 0, 0))
            entry.external_attr = 0o644 << 16
            archive.writestr(entry, content, zipfile.ZIP_DEFLATED)
    return wheel


if __name__ == "__main__":
    print(build_wheel(sys.argv[1]))
