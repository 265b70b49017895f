"""The addresses of the project in a wheel's metadata: those of the repository whose workflow builds it.

The source names no host, so that a copy that somebody carries on does not send its users to another one.
"""

from __future__ import annotations

import os
from collections.abc import Mapping
from typing import Any

from hatchling.metadata.plugin.interface import MetadataHookInterface


def project_urls(environ: Mapping[str, str]) -> dict[str, str]:
    """The addresses, from what GitHub tells its workflows; none elsewhere."""
    server, repository = environ.get("GITHUB_SERVER_URL", ""), environ.get("GITHUB_REPOSITORY", "")
    if not server or not repository:
        return {}
    owner, _, name = repository.partition("/")
    source = f"{server}/{repository}"
    return {
        "Documentation": f"https://{owner}.github.io/{name}/",
        "Source": source,
        "Issues": f"{source}/issues",
        "Changelog": f"{source}/blob/main/.github/CHANGELOG.md",
    }


class ProjectUrls(MetadataHookInterface):
    """What hatchling calls while it builds."""

    def update(self, metadata: dict[str, Any]) -> None:
        metadata["urls"] = project_urls(os.environ)
