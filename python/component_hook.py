"""Adds the component to the wheel: the file that RELAY_CONTACT_FMU names, else that of this project."""

import os
from typing import Any

from hatchling.builders.hooks.plugin.interface import BuildHookInterface


class ComponentHook(BuildHookInterface[Any]):
    """Adds the component."""

    def initialize(self, version: str, build_data: dict[str, Any]) -> None:  # noqa: ARG002
        """Name the file and its place in the wheel."""
        component = os.environ.get("RELAY_CONTACT_FMU", "dist/RelayContact.fmu")
        build_data["force_include"][component] = "relay_contact/data/RelayContact.fmu"
