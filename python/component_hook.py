"""Adds the component, its bill of materials and the page to the wheel, which is for the component's platform alone.

The component is the file that RELAY_CONTACT_FMU names, else that of this project, built by cargo where it is not there
yet, as in a source distribution. RELAY_CONTACT_PLATFORM is the wheel's platform tag, else this machine's.
"""

import os
import platform
import subprocess
import sysconfig
import tempfile
import zipfile
from pathlib import Path
from typing import Any

from hatchling.builders.hooks.plugin.interface import BuildHookInterface

FOLDERS = {
    ("linux", "x86_64"): "linux64",
    ("linux", "aarch64"): "aarch64-linux",
    ("win", "amd64"): "win64",
    ("macosx", ""): "darwin64",
}
"""The folder of a platform's library in the component, by system and processor."""


def tag() -> str:
    """Return the platform tag of what is built on this machine."""
    # Python for macOS runs on both processors; what is built here does not.
    here = sysconfig.get_platform().replace("universal2", platform.machine())
    return os.environ.get("RELAY_CONTACT_PLATFORM") or here.replace("-", "_").replace(".", "_")


def folder(name: str) -> str | None:
    """Return the folder of the library for a platform tag."""
    for (system, processor), found in FOLDERS.items():
        if system in name and name.endswith(processor):
            return found
    return None


class ComponentHook(BuildHookInterface[Any]):
    """Adds the component."""

    def initialize(self, version: str, build_data: dict[str, Any]) -> None:  # noqa: ARG002
        """Name the files and their places in the wheel."""
        root = Path(self.root)
        component = Path(os.environ.get("RELAY_CONTACT_FMU", root / "dist/RelayContact.fmu"))
        if not component.exists() and "RELAY_CONTACT_FMU" not in os.environ:
            subprocess.run(["cargo", "xtask", "fmu"], cwd=root, check=True)
        name = tag()
        place = folder(name)
        with zipfile.ZipFile(component) as archive:
            if not any(file.startswith(f"binaries/{place}/") for file in archive.namelist()):
                raise ValueError(f"{component} has no library for {name}")
            bill = archive.read("documentation/sbom.cdx.json")
        build_data["pure_python"] = False
        build_data["tag"] = f"py3-none-{name}"
        build_data["force_include"][str(component)] = "relay_contact/data/RelayContact.fmu"
        page = root / "dist/explore.html"
        if page.exists():
            build_data["force_include"][str(page)] = "relay_contact/data/explore.html"
        self.temporary = tempfile.TemporaryDirectory()
        path = Path(self.temporary.name) / "relay-contact.cdx.json"
        path.write_bytes(bill)
        build_data["sbom_files"].append(str(path))

    def finalize(self, version: str, build_data: dict[str, Any], artifact_path: str) -> None:  # noqa: ARG002
        """Delete what was unpacked."""
        self.temporary.cleanup()
