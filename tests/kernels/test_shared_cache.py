"""What all accounts share is read only where nobody but its owner may write it."""

from __future__ import annotations

import os
from collections.abc import Callable
from pathlib import Path

import pytest

from kit.kernels import shared_cache
from kit.kernels.shared_cache import kept_files, let_all_read, make_ready, unshared_reason

STRANGER = 54_321


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    made = tmp_path / "kernels" / "__pycache__"
    made.mkdir(parents=True)
    made.parent.chmod(0o755)
    (made / "a.nbi").write_bytes(b"index")
    (made / "a.1.nbc").write_bytes(b"code")
    (made / "other.pyc").write_bytes(b"")
    made.chmod(0o755)
    let_all_read(made)
    return made


def test_a_folder_that_only_its_owner_writes_is_shared(folder: Path) -> None:
    assert unshared_reason(folder) == ""


def _link(folder: Path) -> None:
    (folder / "a.1.nbc").unlink()
    (folder / "a.1.nbc").symlink_to("/tmp/anything")


@pytest.mark.parametrize(
    "spoil",
    [
        pytest.param(lambda folder: folder.chmod(0o757), id="folder for everybody"),
        pytest.param(lambda folder: folder.chmod(0o775), id="folder for a group"),
        pytest.param(lambda folder: (folder / "a.nbi").chmod(0o646), id="a file for everybody"),
        pytest.param(_link, id="a link"),
        pytest.param(lambda folder: folder.rename(folder.with_name("gone")), id="no folder"),
    ],
)
def test_it_is_refused_with_a_reason_where_others_may_write(
    folder: Path, spoil: Callable[[Path], object]
) -> None:
    spoil(folder)
    assert str(folder) in unshared_reason(folder)


@pytest.mark.skipif(os.geteuid() != 0, reason="only root gives a file to another account")
def test_a_file_of_another_account_is_refused_and_removed(folder: Path) -> None:
    os.chown(folder / "a.nbi", STRANGER, STRANGER)
    assert "a.nbi" in unshared_reason(folder)
    make_ready(folder)
    assert list(kept_files(folder)) == []


def test_what_others_may_have_written_is_removed_and_the_rest_stays(folder: Path) -> None:
    make_ready(folder)
    assert len(list(kept_files(folder))) == 2
    folder.chmod(0o777)
    make_ready(folder)
    assert list(kept_files(folder)) == []
    assert (folder / "other.pyc").exists()
    assert unshared_reason(folder) == ""


def test_no_folder_is_made_where_others_may_replace_it(folder: Path) -> None:
    folder.parent.chmod(0o777)
    with pytest.raises(PermissionError):
        make_ready(folder)


def test_the_files_of_a_careful_umask_are_opened_for_reading(folder: Path) -> None:
    (folder / "a.nbi").chmod(0o600)
    assert let_all_read(folder) == len(b"index") + len(b"code")
    assert (folder / "a.nbi").stat().st_mode & 0o777 == 0o644


def test_the_folders_lie_in_the_installation() -> None:
    assert all(shared_cache.PACKAGE in each.parents for each in shared_cache.shared_folders())
