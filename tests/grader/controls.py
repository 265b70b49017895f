"""Takes each defence of the grader's away, in a copy of the project, and shows that the test which holds it then fails.

``python -m tests.grader.controls`` goes through all; words choose those whose names hold them. Exit code 1 if a test passes
without its defence, or fails with it. What a test holds only on some machines (as root, with Landlock) is tried only there.
"""

from __future__ import annotations

import argparse
import os
import re
import shutil
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from enum import Enum
from pathlib import Path
from typing import Final

ROOT: Final = Path(__file__).parents[2]
COPIED: Final = (
    "kit",
    "grader",
    "lessons",
    "maps",
    "tests",
    ".github",
    "pyproject.toml",
    "README.md",
    "constraints.txt",
)
LIMIT_S: Final = 600.0
"""Wall clock of one test."""
HANG_S: Final = 60.0
"""Wall clock after which a test that never ends without its defence is ended; at least three times what it takes with it."""
BROKEN: Final = re.compile(
    r"^E +(NameError|UnboundLocalError|ImportError|ModuleNotFoundError):", re.MULTILINE
)
"""What a test says of code that is no program any more."""


@dataclass(frozen=True, slots=True)
class Control:
    """One defence, how it is taken away, and the test that must then fail."""

    name: str
    file: str
    defence: str
    """What stands in the file, once."""
    without: str
    """What stands there in its place."""
    test: str
    hangs: bool = False
    """Whether the test never ends without it, or takes many times as long."""


CONTROLS: Final = (
    Control(
        "a run whose events command a terminal",
        "kit/learning/training/events.py",
        "data = _shown_safely(json.loads(line))",
        "data = json.loads(line)",
        "learning/training/test_hostile_runs.py::test_what_a_run_of_somebody_elses_says_commands_no_terminal",
    ),
    Control(
        "a run that counts other outcomes than there are",
        "kit/learning/training/events.py",
        "        if len(counts) != len(EpisodeOutcome) or min(counts) < 0:",
        "        if not counts:",
        "learning/training/test_hostile_runs.py::test_counts_of_other_outcomes_than_there_are_are_no_event",
    ),
    Control(
        "a reward in somebody else's run, with one's own rights",
        "kit/learning/tasks/student_reward.py",
        "level=highest_level_up_to(max(Level)))",
        "level=Level.LIMITED)",
        "learning/training/test_hostile_runs.py::test_a_reward_in_somebody_elses_run_does_not_run_with_ones_rights",
    ),
    Control(
        "a controller that somebody else's run imitates, with one's own rights",
        "kit/learning/training/controller_demonstrator.py",
        "INTERACTIVE_LEVEL if is_kits else highest_level_up_to(max(Level))",
        "INTERACTIVE_LEVEL",
        "learning/training/test_hostile_runs.py::test_a_controller_that_somebody_elses_run_imitates_does_not_run_with_ones_rights",
    ),
    Control(
        "a checkpoint that counts below nothing",
        "kit/learning/training/checkpoint_file.py",
        "    if not (len(text) < 20 and 0 <= int(text) <= MAX_NUMBER):\n",
        "    if text is None:\n",
        "learning/training/test_hostile_runs.py::test_numbers_that_no_learner_has_are_no_checkpoint",
    ),
    Control(
        "a replay buffer with actions that there are not",
        "kit/learning/training/checkpoint_file.py",
        "    if len(found) and not (found.min() >= 0 and found.max() < count):\n",
        "    if found is None:\n",
        "learning/training/test_hostile_runs.py::test_arrays_that_no_learner_has_are_no_checkpoint[boltzmann-dqn]",
    ),
    Control(
        "settings of somebody else's run that repeat without end",
        "kit/learning/training/presets.py",
        "most = MAX_REPEATS if name in REPEATS else MAX_COUNT",
        "most = MAX_COUNT",
        "learning/training/test_hostile_runs.py::test_settings_that_take_any_memory_or_never_look_are_refused",
        hangs=True,
    ),
    Control(
        "settings of somebody else's run that take any memory",
        "kit/learning/training/presets.py",
        "            if numbers * 4 > MAX_HELD_BYTES:\n",
        "            if numbers < 0:\n",
        "learning/training/test_hostile_runs.py::test_settings_that_take_any_memory_or_never_look_are_refused",
    ),
    Control(
        "events without end",
        "kit/line_log.py",
        "            if skips := size - self._offset > MAX_READ_BYTES:\n",
        "            if skips := size < 0:\n",
        "learning/training/test_hostile_runs.py::test_events_without_end_are_read_at_their_end",
        hangs=True,
    ),
    Control(
        "an event that is longer than any",
        "kit/line_log.py",
        "opened.readline(MAX_LINE_BYTES)",
        "opened.readline()",
        "learning/training/test_hostile_runs.py::test_a_line_that_is_too_long_is_passed_over_and_cut_off_nowhere",
    ),
    Control(
        "a lock of somebody else's that names a process of one's own",
        "kit/learning/training/training_sweep.py",
        "if process > 1 and holds_open(process, self.folder / LOCK_FILE):",
        "if process > 1:",
        "learning/training/test_hostile_runs.py::test_a_sweep_of_somebody_elses_ends_no_process_of_ones_own",
    ),
    Control(
        "a link in somebody else's run to a file of one's own",
        "kit/plain_files.py",
        "elif not entry.is_file(follow_symlinks=False):",
        "elif not entry.is_file():",
        "learning/training/test_runs.py::test_a_run_of_somebody_elses_leads_to_no_file_of_ones_own_and_holds_nobody",
    ),
    Control(
        "a sweep of somebody else's",
        "kit/learning/training/training_sweep.py",
        "if folder.exists() and (part := foreign_part(folder)):",
        "if not folder and (part := foreign_part(folder)):",
        "learning/training/test_training_sweep.py::test_a_sweep_of_somebody_elses_leads_to_no_file_of_ones_own",
    ),
    Control(
        "a program of the ladder that reads the others",
        "grader/cohort/program_ladder.py",
        "    if not any(\n",
        "    if True or not any(\n",
        "grader/cohort/test_program_ladder.py::test_a_program_sees_none_of_the_others_but_what_is_its_own",
    ),
    Control(
        "walls on top of one another among others that are not",
        "kit/world/overlaps.py",
        "    found = round(count * len(first) / len(drawn))\n",
        "    found = 0\n",
        "world/test_overlaps.py::test_what_lies_on_top_of_itself_is_refused",
    ),
    Control(
        "the public cases known by heart",
        "grader/grading.py",
        "min(_joint_share(each, criterion.need) for each in (shares, secret))",
        "_joint_share(shares, criterion.need)",
        "grader/test_empty_ideas.py::test_who_knows_the_public_cases_by_heart_earns_nothing",
    ),
    Control(
        "an impostor's name while its holder renews",
        "kit/school/game/league/entries.py",
        "    return not is_same, not is_holder, status.st_ctime_ns, file.name\n",
        "    return not is_same, False, status.st_ctime_ns, file.name\n",
        "school/game/league/test_league.py::test_who_renews_an_entry_keeps_its_name",
    ),
    Control(
        "a program that is called an agent",
        "kit/learning/policies/policy_node_text.py",
        "    if (head, between, rest) != _template() or count not in map(_count_text, (None, *_goal_kinds())):\n",
        "    if not learned:\n",
        "school/game/league/test_league.py::test_an_agent_is_who_has_the_kits_node_of_one",
    ),
    Control(
        "a program's drive in a file of drives by hand",
        "kit/school/game/leaderboard.py",
        "                    else other.driver is not each.driver is DriverKind.HAND\n",
        "                    else False\n",
        "school/game/test_leaderboard.py::test_a_drive_of_a_program_is_none_by_hand",
    ),
    Control(
        "a link in the leaderboard's folder to a file of one's own",
        "kit/school/game/leaderboard.py",
        "write_atomically(_name_file(folder, os.getuid()), content, follows_links=False)",
        "write_atomically(_name_file(folder, os.getuid()), content)",
        "school/game/test_leaderboard.py::test_a_link_that_another_user_has_put_there_leads_to_no_file_of_ones_own",
    ),
    Control(
        "a link in a league's folder to a file of one's own",
        "kit/workspace.py",
        "        if follows_links:\n            path = path.resolve()\n",
        "        path = path.resolve()\n",
        "school/game/league/test_league.py::test_a_link_that_another_user_has_put_there_leads_to_no_file_of_ones_own",
    ),
    Control(
        "a league whose list is full of files that take no part",
        "kit/school/game/league/entries.py",
        ">= MAX_LISTED_OF_ONE_USER:",
        ">= MAX_BYTES:",
        "school/game/league/test_league.py::test_who_came_first_with_many_files_keeps_nobody_out",
    ),
    Control(
        "a reply that sleeps and computes a twentieth of the time",
        "kit/host/process.py",
        "                extra_s = delayed_s(self._program) - delayed_before_s\n",
        "                extra_s = used_s / 0.05\n",
        "host/test_process.py::test_who_computes_now_and_then_and_sleeps_is_ended_by_the_wall_clock",
    ),
    Control(
        "a drive whose input names no topic",
        "kit/school/game/shared_drives.py",
        "type(each.content[0]) is not str or ",
        "",
        "school/game/test_leaderboard.py::test_a_damaged_drive_is_passed_over",
    ),
    Control(
        "one user's drives that take hours to run again",
        "kit/school/game/leaderboard.py",
        "_Judge(user, MAX_TICKS_OF_ONE_USER * len(read))",
        "_Judge(user, 10**12)",
        "school/game/test_leaderboard.py::test_many_files_of_one_user_make_nobody_wait",
    ),
    Control(
        "a host that sends a frame byte by byte",
        "kit/inspection/sockets.py",
        "            if time.monotonic() > ends:\n",
        "            if ends is None:\n",
        "school/game/test_shared_game.py::test_a_host_that_sends_a_frame_byte_by_byte_is_left",
    ),
    Control(
        "commands without end that keep a match from being judged",
        "kit/school/game/shared_drives.py",
        "            if each.content[0] in following:\n",
        "            if each.content is following:\n",
        "school/game/test_leaderboard.py::test_a_drive_with_many_messages_a_tick_is_shared_and_the_same",
    ),
    Control(
        "a league full of one user's entries",
        "kit/school/game/league/entries.py",
        "            elif user != owner and others >= MAX_OF_ONE_USER:\n",
        "            elif user != owner and others >= MAX_ENTRIES:\n",
        "school/game/league/test_league.py::test_one_user_has_few_entries_in_anothers_league",
    ),
    Control(
        "a task that pays for driving up and down",
        "grader/kinds/task/posed_task.py",
        "return (*driven, *self._drive_loops([*self._back_and_forth_plans(driven[: len(alone)])]))",
        "return driven",
        "grader/kinds/test_task.py::test_driving_back_and_forth_is_a_loop_too",
    ),
    Control(
        "a space that changes in mid-episode",
        "grader/kinds/environment/examination.py",
        "self.record.changed_spaces.setdefault(name, what)",
        "pass",
        "grader/kinds/environment/test_kind.py::test_a_mistake_loses_what_it_is_about",
    ),
    Control(
        "a value that fails when it is looked at",
        "grader/kinds/environment/environment_examiner.py",
        "        return _describe_value(value, depth)\n    except Exception:",
        "        return _describe_value(value, depth)\n    except ZeroDivisionError:",
        "grader/kinds/environment/test_kind.py::test_a_reward_that_is_no_number_is_told_in_the_words_of_the_task",
    ),
    Control(
        "a loop that sleeps where a timer is asked",
        "grader/driving/service_calls.py",
        "                    self._late.add(name)\n",
        "                    pass\n",
        "grader/driving/test_episodes.py::test_an_answer_that_comes_late_is_none",
    ),
    Control(
        "formulas of a platform's own export",
        "grader/cohort/exports.py",
        "[without_formula(cell) for cell in row]",
        "row",
        "grader/cohort/test_class_list.py::test_nothing_of_a_platforms_export_comes_back_as_a_formula",
    ),
    Control(
        "a power of powers in a launch file",
        "kit/ros/launch/expressions.py",
        "        _check_size(base.bit_length() * exponent, MAX_BITS)\n",
        "        pass\n",
        "ros/launch/test_bounds.py::test_an_expression_whose_result_would_be_very_large_is_not_computed",
        hangs=True,
    ),
    Control(
        "a long text in a platform's worksheet",
        "grader/cohort/csv_file.py",
        "csv.field_size_limit(MAX_BYTES)",
        "csv.field_size_limit()",
        "grader/cohort/test_class_list.py::test_what_a_student_typed_into_the_worksheet_costs_nobody_a_grade",
    ),
    Control(
        "one drive in the places of all levels of a board",
        "kit/school/game/leaderboard.py",
        "(hashlib.sha256(content).digest(), level.id, driver)",
        '(hashlib.sha256(content).digest(), "", driver)',
        "school/game/test_leaderboard.py::test_one_drive_in_the_places_of_all_levels_makes_nobody_wait",
    ),
    Control(
        "findings about another submission",
        "grader/cohort/queue.py",
        '            if content["of"] != of:\n',
        "            if not of:\n",
        "grader/evidence/test_findings.py::test_a_changed_word_regrades_a_class_without_a_program",
    ),
    Control(
        "a package whose name leads to another folder",
        "kit/ros/packages.py",
        "    if name and not _NAME.fullmatch(name):\n",
        "    if name is None:\n",
        "ros/test_packages.py::test_a_name_that_cannot_be_a_folders_is_none",
    ),
    Control(
        "a package that installs files of others",
        "kit/ros/packages.py",
        "if not source.resolve().is_relative_to(folder.resolve()):",
        "if False:",
        "ros/test_packages.py::test_a_package_installs_its_own_files_alone",
    ),
    Control(
        "a pip.py beside a submission in CI",
        "grader/ci/services/github.py",
        "        run: python -P -m pip install --quiet",
        "        run: cd $GITHUB_WORKSPACE && python -m pip install --quiet",
        "grader/ci/test_services.py::test_a_workflow_grades_and_runs_nothing_of_the_students",
    ),
    Control(
        "a secret handed on by the page cache",
        "grader/evidence/evidence_scores.py",
        "        if self._has_run_public:\n            return\n        self._has_run_public = True\n",
        "        return\n",
        "grader/test_secrets.py::test_nothing_that_a_student_reads_of_is_run_after_a_secret_run",
    ),
    Control(
        "rewards whose sums are infinite",
        "grader/evidence/submission_clock.py",
        "    def check(self) -> None:\n",
        "    def check(self) -> None:\n        return\n\n    def _unused_check(self) -> None:\n",
        "grader/test_returned_numbers.py::test_a_calculation_ends_with_the_submissions_time",
    ),
    Control(
        "a folder exchanged for a link while it is read",
        "grader/submission.py",
        "flags = os.O_RDONLY | os.O_DIRECTORY | os.O_NOFOLLOW | os.O_CLOEXEC",
        "flags = os.O_RDONLY | os.O_DIRECTORY | os.O_CLOEXEC",
        "grader/test_submission.py::test_a_name_exchanged_for_a_link_while_it_is_read_leads_nowhere",
    ),
    Control(
        "a hard link of another's",
        "grader/submission.py",
        "    if status.st_nlink < 2:\n",
        "    if status.st_nlink < 1000:\n",
        "grader/test_submission.py::test_a_hard_link_that_another_can_have_made_is_not_read",
    ),
    Control(
        "memory in pipes",
        "kit/host/sandbox/seccomp.py",
        '    "pipe2": (293, 59), "eventfd"',
        '    "pipe2": (293, 59), "vmsplice": (278, 75), "eventfd"',
        "host/sandbox/test_confinement.py::test_no_attack_gets_anywhere",
    ),
    Control(
        "a disk of files that are mapped and unlinked",
        "kit/host/sandbox/namespaces.py",
        'return f"size={room},nr_inodes={files + 1},mode=700"',
        'return f"size={100 * room},nr_inodes={files + 1},mode=700"',
        "host/sandbox/test_promises.py::test_files_that_nobody_sees_fill_a_disk_that_is_not_their_own",
    ),
    Control(
        "a lesson that is checked at its own level",
        "grader/grading_level.py",
        "    return max(assignment.level, Level.FILTERED) if requested is None else requested\n",
        "    return assignment.level if requested is None else requested\n",
        "grader/cli/test_check_level.py::test_a_lesson_checked_for_somebody_else_writes_nothing",
    ),
    Control(
        "a queue and a workspace that everybody reads",
        "kit/workspace.py",
        "        folder.chmod(stat.S_IMODE(status.st_mode) & 0o700)\n",
        "        pass\n",
        "test_neighbours.py::test_a_workspace_and_a_queue_that_are_open_are_closed",
    ),
    Control(
        "signals of the user",
        "kit/host/sandbox/privileges.py",
        "        wanted[resource.RLIMIT_SIGPENDING] = MAX_PENDING_SIGNALS\n",
        "",
        "host/sandbox/test_confinement.py::test_no_attack_gets_anywhere",
    ),
    Control(
        "an old result in a checkout",
        "grader/ci/services/gitlab.py",
        '    - rm -rf "$CI_PROJECT_DIR/.grade"',
        '    - true "$CI_PROJECT_DIR/.grade"',
        "grader/ci/test_services.py::test_a_result_that_lay_in_the_checkout_is_not_reported",
    ),
    Control(
        "a header of very many records",
        "grader/archives/tar_archive.py",
        "    for _ in range(MAX_HEADER_RECORDS + 1):\n",
        "    while True:\n",
        "grader/test_submission.py::test_a_header_of_very_many_records_is_refused_at_once",
    ),
    Control(
        "a program that stands still in a race",
        "kit/school/game/race.py",
        "install_driver, on_second, confinement, wall_limit_s, seed, limits)\n",
        "install_driver, on_second, confinement, seed=seed, limits=limits)\n",
        "grader/cohort/test_program_ladder.py::test_a_race_has_a_wall_clock",
        hangs=True,
    ),
    Control(
        "a recording or a policy that a teacher merely opens",
        "kit/array_archives.py",
        "        check_arrays(archive, max_bytes)\n",
        "        pass\n",
        "test_plain_files.py::test_an_archive_that_unpacks_to_far_more_takes_no_memory",
    ),
    Control(
        "a recording that names a file elsewhere",
        "kit/run/scenario.py",
        "        if not any(file.resolve().is_relative_to(folder) for folder in near):\n",
        "        if not near:\n",
        "test_plain_files.py::test_a_recording_names_no_file_elsewhere",
    ),
    Control(
        "a model whose tensors are larger than what is stored",
        "kit/learning/policies/torch_weights.py",
        "        if 4 * sum(math.prod(tensor.shape) for tensor in tensors.values()) > MAX_UNPACKED_BYTES:\n",
        "        if False:\n",
        "learning/policies/test_hostile_files.py::test_no_model_takes_memory_or_says_more_than_a_sentence",
    ),
    Control(
        "a policy whose task names a program",
        "kit/learning/tasks/task_reader.py",
        'if self._is_kept and name != _named_in(self._file, "file", "reward"):',
        "if False:",
        "learning/policies/test_hostile_files.py::test_a_policy_names_no_program_that_runs_with_ones_rights",
    ),
    Control(
        "a program that a policy's task names, with one's own rights",
        "kit/learning/tasks/student_reward.py",
        "level=highest_level_up_to(max(Level)))",
        "level=Level.LIMITED)",
        "learning/policies/test_hostile_files.py::test_a_policy_names_no_program_that_runs_with_ones_rights",
    ),
    Control(
        "a criterion whose turn comes although one before that had none",
        "grader/evidence/evidence_scores.py",
        "return self.is_its_turn(before) and any(",
        "return any(",
        "grader/test_grading.py::test_what_comes_after_what_had_not_its_turn_has_not_its_turn_either",
    ),
    Control(
        "a billionth for the way beside a reward for arriving",
        "grader/kinds/reward/behaviours.py",
        "    margin = NOTICED * float(np.abs(rewards).max())\n",
        "    margin = 0.0\n",
        "grader/kinds/reward/test_kind.py::test_what_is_paid_for_the_way_is_noticed",
    ),
    Control(
        "a loop that pays, beside a great reward for arriving",
        "grader/kinds/reward/behaviours.py",
        "return self.round_pay > 0.0 or self._pays_as_well",
        "return self._pays_as_well",
        "grader/kinds/reward/test_kind.py::test_a_loop_that_pays_is_not_hidden_by_what_arriving_pays",
    ),
    Control(
        "a checkpoint that unpacks to far more",
        "kit/learning/training/checkpoint_file.py",
        "            check_stored(archive, size)\n",
        "",
        "learning/training/test_runs.py::test_a_checkpoint_of_somebody_elses_unpacks_to_no_more_than_it_is",
    ),
    Control(
        "exports that are huge",
        "kit/plain_files.py",
        "    if content is None or len(content) > limit:\n",
        "    if content is None:\n        content = Path(file).read_bytes()\n    if False:\n",
        "school/report/test_class_data.py::test_a_file_larger_than_any_export_is_left_out",
    ),
    Control(
        "a pipe that holds a reader",
        "kit/plain_files.py",
        "    flags = os.O_RDONLY | os.O_NONBLOCK | os.O_CLOEXEC",
        "    flags = os.O_RDONLY | os.O_CLOEXEC",
        "learning/training/test_runs.py::test_a_named_pipe_is_no_checkpoint",
        hangs=True,
    ),
    Control(
        "an environment variable that grants folders",
        "kit/host/sandbox/grants.py",
        "        return [path for path in named if os.path.realpath(path) in loaded]\n",
        "        return named\n",
        "host/sandbox/test_grants.py::test_the_environment_grants_no_folder",
    ),
    Control(
        "an environment that moves its robot and never drives",
        "grader/kinds/environment/examination.py",
        "        return service in self._services and not self.is_in_step\n",
        "        return service in self._services\n",
        "grader/driving/test_checks.py::test_an_environment_moves_its_robot_only_where_an_episode_begins",
    ),
    Control(
        "a program that drives the other robot",
        "grader/driving/episodes.py",
        "for name in traffic if name in self._others_topics]",
        "for name in traffic if not name]",
        "grader/driving/test_checks.py::test_a_program_drives_no_other_robot",
    ),
    Control(
        "slow near walls by the clock",
        "grader/driving/following.py",
        "    share = min(shares.values()) if len(shares) == len(asked) else 0.0\n",
        "    share = 1.0\n",
        "grader/driving/test_checks.py::test_the_speed_must_follow_what_the_laser_measures",
    ),
    Control(
        "round and round without a laser",
        "grader/driving/checks/ways.py",
        "    return PLACE_SIZE * (len(np.unique(places, axis=0)) - 1) if len(places) else 0.0\n",
        "    return float(np.hypot(*np.diff(drive.track[:, :2], axis=0).T).sum())\n",
        "grader/driving/test_checks.py::test_to_and_fro_leads_nowhere",
    ),
    Control(
        "all messages in the first tick",
        "grader/driving/message_rate.py",
        "        return max(self.mean_error, self.uneven_share)\n",
        "        return self.mean_error\n",
        "grader/driving/test_checks.py::test_a_rate_is_kept_all_the_time",
    ),
    Control(
        "names that look alike",
        "grader/look_alikes.py",
        "    return look(look(name.translate(_LATIN_OF)).translate(_LATIN_OF))\n",
        "    return name\n",
        "grader/cohort/test_cohort.py::test_no_two_names_of_a_class_look_alike",
    ),
    Control(
        "signs in a name that show nothing",
        "grader/look_alikes.py",
        '_UNSEEN.sub("", name)',
        "name",
        "grader/test_look_alikes.py::test_what_looks_the_same_has_one_outline",
    ),
    Control(
        "letters of other alphabets in a name",
        "grader/look_alikes.py",
        "    return look(look(name.translate(_LATIN_OF)).translate(_LATIN_OF))\n",
        "    return look(name)\n",
        "grader/cohort/test_cohort.py::test_no_two_names_of_a_class_look_alike",
    ),
    Control(
        "a repository whose settings name a program",
        "kit/study/kit_commit.py",
        '"-c", "core.fsmonitor=false", ',
        "",
        "study/test_kit_commit.py::test_a_repositorys_settings_run_nothing",
    ),
    Control(
        "a repository above the kit",
        "kit/study/kit_commit.py",
        '"GIT_CEILING_DIRECTORIES": str(folder.parent), ',
        "",
        "study/test_kit_commit.py::test_a_repository_of_anybodys_is_not_asked",
    ),
    Control(
        "a checkpoint that holds code",
        "kit/learning/training/tabular.py",
        "allow_pickle=False",
        "allow_pickle=True",
        "learning/training/test_training.py::test_a_hostile_checkpoint_runs_nothing",
    ),
    Control(
        "an optimiser's state of another size",
        "kit/learning/training/torch_parts.py",
        'raise ValueError(f"{name} does not fit the network")',
        "pass",
        "learning/training/test_torch_parts.py::test_an_array_of_another_size_is_refused",
    ),
    Control(
        "a picture that is decoded for minutes",
        "kit/world/layer_reader.py",
        "return scans > most",
        "return False",
        "world/test_layer_reader.py::test_a_picture_that_goes_over_its_pixels_again_and_again_is_refused",
    ),
    Control(
        "a picture that another program draws",
        "kit/mapmaking/photo.py",
        '(*FORMATS, "WEBP", "GIF", "TIFF")',
        '(*FORMATS, "EPS")',
        "mapmaking/test_photo.py::test_no_other_program_draws_a_picture",
    ),
    Control(
        "a crash whose memory is kept",
        "kit/host/sandbox/seccomp.py",
        ", refused=(1, LIMIT_OF_CORES)",
        "",
        "host/sandbox/test_confinement.py::test_the_filter_decides_each_call_rightly",
    ),
    Control(
        "a path that tells a process",
        "kit/host/private_folder.py",
        "key=_BOOT, ",
        "",
        "host/test_private_folder.py::test_its_name_tells_no_process",
    ),
    Control(
        "a command of a CI service in a note",
        "grader/cli/exits.py",
        "    click.echo(plain(message), err=True)\n",
        "    click.echo(message, err=True)\n",
        "grader/cohort/test_cohort.py::test_a_note_gives_a_ci_service_no_command",
    ),
    Control(
        "a common folder of whoever came first",
        "kit/workspace.py",
        "    if status.st_uid not in (0, os.geteuid()):\n",
        "    if status.st_uid < 0:\n",
        "test_workspace.py::test_a_common_folder_of_another_user_is_refused",
    ),
    Control(
        "a program that reads otherwise than it runs",
        "grader/hidden_code.py",
        "    if encoding.removesuffix(\"-sig\") not in READ_AS_SHOWN:\n",
        "    if not encoding:\n",
        "grader/test_submission.py::test_what_reads_otherwise_than_it_runs_is_refused",
    ),
    Control(
        "a stranger's reference",
        "grader/author_code.py",
        "    confine_reader(readable, granted.listed, [scratch], starts_programs=False)\n",
        "",
        "grader/test_author_code.py::test_it_reaches_nothing",
    ),
    Control(
        "what the grader has open, read by a stranger's reference",
        "grader/author_code.py",
        "    os.closerange(FIRST_OWN_DESCRIPTOR, writer)\n",
        "",
        "grader/test_author_code.py::test_it_reaches_nothing",
    ),
    Control(
        "threads of root that nobody counts",
        "kit/host/sandbox/control_groups.py",
        '                _write_group_file(f"{folder}/pids.max", processes)\n',
        "                pass\n",
        "host/sandbox/test_control_groups.py::test_threads_of_root_are_counted",
    ),
    Control(
        "a frame at the wrong time",
        "kit/host/protocol.py",
        "    if not isinstance(frame, ALLOWED_FRAMES[state]):\n",
        "    if not frame:\n",
        "host/test_states.py::test_every_frame_in_every_state",
    ),
    Control(
        "a forged number of an endpoint",
        "kit/host/proxy_nodes.py",
        "        if not isinstance(endpoint, kind):\n",
        "        if endpoint is None:\n",
        "host/test_forgery.py::test_a_forged_answer_ends_the_process",
    ),
    Control(
        "one user for all runs",
        "kit/host/sandbox/privileges.py",
        "        os.setresuid(user, user, user)\n",
        "",
        "host/sandbox/test_confinement.py::test_two_runs_have_two_users",
    ),
    Control(
        "groups of a killed kit",
        "kit/host/sandbox/control_groups.py",
        "            _remove_abandoned(each.folder)\n",
        "            pass\n",
        "host/sandbox/test_control_groups.py::test_the_groups_of_a_killed_kit_are_removed_at_the_next_start",
    ),
    Control(
        "AIO requests of the machine",
        "kit/host/sandbox/seccomp.py",
        '    "pipe2": (293, 59), "eventfd"',
        '    "pipe2": (293, 59), "io_setup": (206, 0), "eventfd"',
        "host/sandbox/test_confinement.py::test_no_attack_gets_anywhere",
    ),
    Control(
        "files in flight",
        "kit/host/sandbox/seccomp.py",
        '    "pipe2": (293, 59), "eventfd"',
        '    "pipe2": (293, 59), "sendmsg": (46, 211), "eventfd"',
        "host/sandbox/test_confinement.py::test_no_attack_gets_anywhere",
    ),
    Control(
        "flags of the library",
        "kit/host/sandbox/seccomp.py",
        '    "pipe2": (293, 59), "eventfd"',
        '    "pipe2": (293, 59), "ioctl": (16, 29), "eventfd"',
        "host/sandbox/test_confinement.py::test_no_attack_gets_anywhere",
    ),
    Control(
        "what of a file is in memory, by a flag of reading",
        "kit/host/sandbox/seccomp.py",
        '    "pipe2": (293, 59), "eventfd"',
        '    "pipe2": (293, 59), "preadv2": (327, 286), "eventfd"',
        "host/sandbox/test_confinement.py::test_the_filter_decides_each_call_rightly",
    ),
    Control(
        "a result of another submission",
        "grader/cohort/queue.py",
        "        if key not in keys:\n            return False\n",
        "",
        "grader/cohort/test_queue.py::test_the_result_of_another_submission_gives_it_no_grade",
    ),
    Control(
        "a worker's result that is too large",
        "kit/host/job_executors.py",
        "read_plain_file(file, MAX_RESULT_BYTES)",
        "read_plain_file(file, 10 * MAX_RESULT_BYTES)",
        "grader/cohort/test_queue.py::test_a_file_that_is_no_result_is_not_read",
    ),
    Control(
        "a worker's result with a number that is none",
        "kit/host/job_executors.py",
        "        json.dumps(content, allow_nan=False)  # 1e999 is read as infinity\n",
        "",
        "grader/cohort/test_queue.py::test_a_file_that_is_no_result_is_not_read",
    ),
    Control(
        "a worker's incident that comes after a grade",
        "grader/cohort/queue.py",
        "result.verdict is GradingVerdict.BROKEN and self._has_grade(key)",
        "False",
        "grader/cohort/test_queue.py::test_no_verdict_is_lost_by_one_that_comes_late",
    ),
    Control(
        "a job of a queue that is damaged or another work's",
        "grader/cohort/queue.py",
        "if submission is None or job_key(submission, assignment, manifest.grading_options()) != key:",
        "if submission is None:",
        "grader/cohort/test_queue.py::test_a_job_that_is_damaged_or_another_works_is_not_graded_and_is_written_again",
    ),
    Control(
        "a queue's file behind a link",
        "grader/cohort/queue.py",
        ", follows_links=False)",
        ")",
        "grader/cohort/test_queue.py::test_what_lies_in_the_place_of_a_result_is_replaced_and_nothing_behind_it_is_touched",
        hangs=True,
    ),
    Control(
        "a manifest's key that is a path",
        "grader/cohort/queue.py",
        '            if each["key"] is not None and not _KEY.fullmatch(each["key"]):\n',
        "            if False:\n",
        "grader/cohort/test_queue.py::test_a_manifest_that_cannot_be_read_is_named_and_written_again",
    ),
    Control(
        "a worker with another version of the grader",
        "grader/cohort/queue.py",
        "        if manifest.grader_version != grader_version():\n",
        "        if False:\n",
        "grader/cohort/test_queue.py::test_a_worker_with_another_version_of_the_grader_says_so",
    ),
    Control(
        "files of a board that unpack to megabytes",
        "kit/school/game/leaderboard.py",
        " + unpacked_size(content) // BYTES_OF_A_TICK",
        "",
        "school/game/test_leaderboard.py::test_files_that_unpack_to_megabytes_make_nobody_wait",
    ),
    Control(
        "a robot that sends faster than it is read",
        "kit/bridge/channels.py",
        "        for _ in range(len(arrived)):\n",
        "        while arrived:\n",
        "bridge/test_hostile_robot.py::test_a_robot_that_sends_faster_than_it_is_read_does_not_hold_the_world",
    ),
    Control(
        "a robot that announces endpoints without end",
        "kit/bridge/zenoh_wire.py",
        "                    if len(self._tokens) < MAX_ENDPOINTS:\n",
        "                    if True:\n",
        "bridge/test_hostile_robot.py::test_a_robot_that_announces_endpoints_without_end_fills_no_memory",
    ),
    Control(
        "a robot whose messages are too large",
        "kit/bridge/channels.py",
        "        if len(data) <= MAX_MESSAGE_BYTES:\n",
        "        if data is not None:\n",
        "bridge/test_hostile_robot.py::test_what_is_too_large_does_not_wait_in_memory",
    ),
    Control(
        "a robot whose requests the world does not answer",
        "kit/bridge/channels.py",
        "            if self._client.pending_count >= MAX_UNANSWERED:\n",
        "            if self._client.pending_count < 0:\n",
        "bridge/test_hostile_robot.py::test_requests_without_end_that_the_world_does_not_answer_fill_no_memory",
    ),
    Control(
        "a robot whose types change without end",
        "kit/bridge/bridge.py",
        "        if text in told or len(told) > MAX_REPORTS:\n",
        "        if text in told:\n",
        "bridge/test_hostile_robot.py::test_what_a_robot_calls_itself_is_no_command_of_a_terminal_and_fills_no_screen",
    ),
    Control(
        "a robot of a world that moves by itself",
        "grader/kinds/world/run_checks.py",
        "    if run.run.undriven >= LEAST_WAY:\n",
        "    if run.run.undriven < 0.0:\n",
        "grader/kinds/world/test_kind.py::test_a_robot_that_moves_by_itself_is_not_driven",
    ),
    Control(
        "temporary files in a relative folder",
        "kit/host/private_folder.py",
        "os.path.abspath(tempfile.gettempdir())",
        "tempfile.gettempdir()",
        "host/test_private_folder.py::test_its_path_holds_in_every_current_folder",
    ),
    Control(
        "kernels that are not compiled",
        "kit/kernels/numba_import.py",
        'os.environ.pop("NUMBA_DISABLE_JIT", None)\n',
        "\n",
        "kernels/test_kernels.py::test_no_environment_keeps_kernels_from_being_compiled",
    ),
    Control(
        "an array that makes numpy warn",
        "kit/array_archives.py",
        '            ast.literal_eval(part.read(length).decode("latin-1"))',
        "            part.read(length)",
        "test_plain_files.py::test_an_array_as_python_2_wrote_it_is_refused_without_a_warning",
    ),
    Control(
        "a work whose name begins with a dot",
        "grader/cohort/queue.py",
        "            passed_over.append(readable_name(path.name))\n",
        "            pass\n",
        "grader/cohort/test_cohort.py::test_what_is_not_taken_for_a_work_is_said",
    ),
    Control(
        "a folder in the place of another's program in a ladder",
        "grader/cohort/program_ladder.py",
        "programs[distinct_name(names, submission_name(path), shown)] = program",
        "programs[submission_name(path)] = program",
        "grader/cohort/test_program_ladder.py::test_no_program_takes_the_place_or_the_look_of_another",
    ),
    Control(
        "a student's file name that means another student",
        "grader/cohort/roster.py",
        "    found = matches.get(platform) or (next(iter(matches.values())) if len(matches) == 1 else None)\n",
        "    found = next(iter(matches.values()), None)\n",
        "grader/cohort/test_class_list.py::test_what_a_student_chooses_of_a_name_means_no_other_student",
    ),
    Control(
        "launch files that include each other again and again",
        "kit/ros/launch/service.py",
        "            if self._visited_count > MAX_ACTIONS:\n",
        "            if False:\n",
        "ros/launch/test_bounds.py::test_files_that_include_each_other_twice_and_again",
        hangs=True,
    ),
    Control(
        "signs that are not seen",
        "grader/reports/cleaning.py",
        '_UNSEEN.sub("\\N{REPLACEMENT CHARACTER}", text[:limit])',
        "text[:limit]",
        "grader/test_hostile_texts.py::test_no_text_of_a_program_leaves_as_anything_but_text",
    ),
    Control(
        "a SyntaxError of the program's own, whose line is none",
        "kit/host/child/student_module.py",
        "line if type(line) is int and 0 < line <= MAX_ID else None",
        "line or None",
        "grader/test_hostile_texts.py::test_no_text_of_a_program_leaves_as_anything_but_text",
    ),
    Control(
        "very many names of an archive that are ignored",
        "grader/submission.py",
        "        handed_in = [*sorted(names), *sorted(files.ignored)]\n",
        "        handed_in = sorted([*names, *files.ignored], key=lambda path: (path in files.ignored, path))\n",
        "grader/test_submission.py::test_time_grows_with_what_is_handed_in_and_not_with_its_square",
    ),
    Control(
        "paths of very many folders",
        "grader/submitted_files.py",
        "enumerate(parts[:MAX_DEPTH], 1)",
        "enumerate(parts, 1)",
        "grader/test_submission.py::test_time_grows_with_what_is_handed_in_and_not_with_its_square",
        hangs=True,
    ),
    Control(
        "very many empty streams behind each other",
        "grader/archives/streams.py",
        "                if parts > MAX_STREAMS:\n",
        "                if parts < 0:\n",
        "grader/test_submission.py::test_a_file_of_very_many_empty_streams_is_a_bomb",
    ),
    Control(
        "an exit code that tells of what is shown later",
        "grader/cli/check.py",
        "shown = result.for_student() if is_for_student else result",
        "shown = result",
        "grader/cli/test_check.py::test_nothing_tells_how_a_criterion_went_that_is_shown_later",
    ),
    Control(
        "a picture that tells of what is shown later",
        "grader/evidence/evidence_scores.py",
        "for each in scored if self._assignment.criterion(name).visibility is Visibility.VISIBLE else ():",
        "for each in scored:",
        "grader/cli/test_check.py::test_nothing_tells_how_a_criterion_went_that_is_shown_later",
    ),
    Control(
        "a hint that tells of what is shown later",
        "grader/reading.py",
        "[one for one in known[:-1] if visibilities[one] in (Visibility.VISIBLE, visibility)]",
        "known[:-1]",
        "grader/test_known_mistakes.py::test_a_hint_tells_nothing_of_a_criterion_that_is_shown_later",
    ),
    Control(
        "a name in the list of pages",
        "grader/cohort/feedback.py",
        "pages[name] = clean_line(row.name)",
        "pages[name] = row.name",
        "grader/cohort/test_class_list.py::test_no_name_leaves_as_anything_but_text",
    ),
    Control(
        "the seed of a run in a program's own random numbers",
        "kit/host/process.py",
        'self._start_fields["seed"] = child_seed(seed)',
        'self._start_fields["seed"] = seed',
        "host/test_child_memory.py::test_the_state_of_random_comes_from_no_seed_of_a_run",
    ),
    Control(
        "solutions and references that are installed",
        "kit/host/sandbox/grants.py",
        "    hidden = frozenset(_hidden_paths())\n",
        "    hidden = frozenset[str]()\n",
        "host/sandbox/test_grants.py::test_every_package_but_ours_can_be_read",
    ),
    Control(
        "a class that is graded at level 0 without a word",
        "grader/cli/confinement.py",
        "    if text is None and (secret or for_class):\n",
        "    if text is None and secret:\n",
        "grader/cohort/test_cohort.py::test_a_class_is_not_graded_at_level_0_by_silence",
    ),
    Control(
        "a reward so large that the iteration over it never ends",
        "grader/kinds/reward/optimal_policy.py",
        "    for _ in range(1 + math.ceil(math.log(CONVERGENCE_SHARE * (1.0 - discount)) / math.log(discount))):\n",
        "    while True:\n",
        "grader/kinds/reward/test_kind.py::test_the_iteration_ends_whatever_the_rewards_are",
        hangs=True,
    ),
    Control(
        "rewards that are larger than any may be",
        "kit/learning/tasks/student_reward.py",
        "    if abs(largest) > LARGEST_REWARD:\n",
        "    if abs(largest) < 0.0:\n",
        "grader/test_returned_numbers.py::test_whatever_a_reward_returns",
    ),
    Control(
        "folders without end",
        "grader/submitted_files.py",
        "        if len(parts) + is_folder > MAX_DEPTH:\n",
        "        if not parts:\n",
        "grader/test_submission.py::test_folders_without_end_are_not_entered",
    ),
    Control(
        "a header of an archive as large as the memory",
        "grader/archives/tar_archive.py",
        "            if header.size > MAX_HEADER_BYTES:\n",
        "            if header.size < 0:\n",
        "grader/test_submission.py::test_a_large_header_is_refused_before_it_is_read",
    ),
    Control(
        "a directory of an archive as large as the memory",
        "grader/archives/zip_archive.py",
        "        if size > MAX_DIRECTORY_BYTES:\n",
        "        if size < -1:\n",
        "grader/cohort/test_unreadable.py::test_the_process_that_prepares_a_class_survives_every_bomb",
    ),
    Control(
        "a compressed file that asks for 4 GB of memory",
        "grader/archives/streams.py",
        ", memlimit=MAX_DICTIONARY_BYTES",
        "",
        "grader/test_submission.py::test_unpacking_takes_no_more_memory_than_xz_at_its_best",
    ),
    Control(
        "a file in a zip that asks for 4 GB of memory",
        "grader/archives/zip_archive.py",
        "            if entry.compress_type not in (zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED):\n",
        "            if entry.compress_type < 0:\n",
        "grader/cohort/test_unreadable.py::test_the_process_that_prepares_a_class_survives_every_bomb",
    ),
    Control(
        "a reward whose source is parsed for minutes",
        "kit/learning/tasks/student_reward.py",
        "read_plain_file(file, MAX_SOURCE_BYTES)",
        "read_plain_file(file, 100 * MAX_SOURCE_BYTES)",
        "grader/cohort/test_unreadable.py::test_a_large_source_of_a_reward_is_not_parsed",
    ),
    Control(
        "an environment that forges what its examiner says",
        "grader/kinds/environment/examination.py",
        "        return not durations or sum(durations)",
        "        return True or sum(durations)",
        "grader/kinds/environment/test_forgery.py::test_a_forged_examination_earns_what_an_empty_environment_earns",
    ),
    Control(
        "a node with the name of the world's",
        "kit/host/proxy_nodes.py",
        "        if full_name in self._graph.reserved_names:\n",
        "        if not full_name:\n",
        "grader/driving/test_episodes.py::test_the_name_of_the_worlds_node_is_refused",
    ),
    Control(
        "the true state of the world",
        "grader/driving/restricted_runner.py",
        "offered_truths=topics | (services & {GET_STATE})",
        "offered_truths=None",
        "grader/driving/test_episodes.py::test_the_true_state_of_the_world_is_not_offered",
    ),
    Control(
        "a disk full of small files",
        "kit/host/sandbox/namespaces.py",
        "nr_inodes={files + 1}",
        "nr_inodes={100 * files}",
        "grader/test_budgets.py::test_a_program_that_hits_it_fails_by_its_own_fault",
    ),
    Control(
        "every episode as slow as it may be",
        "grader/evidence/submission_clock.py",
        "        if self._timeouts >= MAX_TIMEOUTS:\n",
        "        if self._timeouts < 0:\n",
        "grader/test_submission_clock.py::test_after_two_that_took_too_long_no_other_is_run_and_points_so_far_stay",
    ),
    Control(
        "a flood of messages",
        "kit/host/graph_bridge.py",
        "        if self._message_count > self._max_messages:\n",
        "        if self._message_count < 0:\n",
        "grader/driving/test_episodes.py::test_a_flood_of_commands_ends_the_episode_as_the_programs_failure",
    ),
    Control(
        "a recording whose header is a program",
        "grader/kinds/drive/kind.py",
        "    except READ_ERRORS as error:\n",
        "    except zipfile.BadZipFile as error:\n",
        "grader/cohort/test_unreadable.py::test_a_recording_with_a_broken_header_is_the_students",
    ),
    Control(
        "a criterion that is shown later, seen by its points",
        "kit/results/grading_result.py",
        "        if self.visibility is Visibility.VISIBLE:\n            return self.without_secrets()\n",
        "        if self.visibility:\n            return self.without_secrets()\n",
        "grader/test_secrets.py::test_a_test_that_is_shown_later_is_blank_everywhere",
    ),
    Control(
        "a name that a spreadsheet computes",
        "kit/plain_text.py",
        "cell.startswith(_FORMULA) or cell.lstrip().startswith(_FORMULA)",
        "False",
        "grader/cohort/test_cohort.py::test_a_spreadsheet_gets_no_formula",
    ),
    Control(
        "what the table of promises says of stat",
        "kit/host/sandbox/promises.py",
        "its size and its times\", Level.SEPARATE)",
        "its size and its times\", Level.FILTERED)",
        "host/sandbox/test_promises.py::test_what_a_level_prevents_and_what_it_does_not",
    ),
    Control(
        "what the table of promises says of the machine's load",
        "kit/host/sandbox/promises.py",
        "how much of its disk is free\", None\n",
        "how much of its disk is free\", Level.SEPARATE\n",
        "host/sandbox/test_promises.py::test_what_a_level_prevents_and_what_it_does_not",
    ),
    Control(
        "what the table of promises says of the page cache",
        "kit/host/sandbox/promises.py",
        "lies in memory\",\n        None,\n",
        "lies in memory\",\n        Level.FILTERED,\n",
        "host/sandbox/test_promises.py::test_what_of_a_file_is_in_memory_is_seen_by_a_later_program_at_every_level",
    ),
    Control(
        "a launch file that rewrites the programs beside it",
        "grader/kinds/launch/launch_record.py",
        "        launch.load()\n        _restore_package(target.folder, package_files)\n",
        "        launch.load()\n",
        "grader/kinds/test_launch.py::test_what_it_writes_into_the_package_changes_no_program",
    ),
    Control(
        "a lesson of somebody else's that writes its starter anywhere",
        "kit/school/lessons/reading.py",
        '        if path.is_absolute() or ".." in path.parts:',
        "        if False:",
        "school/lessons/test_foreign_lessons.py::test_an_exercise_writes_nothing_outside_its_folder",
    ),
    Control(
        "a policy whose task names any file of the machine",
        "kit/learning/tasks/task_reader.py",
        'if self._is_kept and name != _named_in(self._file, "world"):',
        "if False:",
        "learning/tasks/test_task_reader.py::test_a_text_from_elsewhere_names_no_file_of_this_machine",
    ),
    Control(
        "a bag with a summary of other types",
        "kit/ros/bags.py",
        "    except Exception as problem:  # noqa: BLE001 - whatever a damaged file makes the library raise\n",
        "    except BagError as problem:\n",
        "ros/test_bags.py::test_a_bag_whose_summary_has_other_types_is_refused",
    ),
    Control(
        "a pipe in a bag",
        "kit/ros/bags.py",
        "        if not each.is_file():\n",
        "        if not each.name:\n",
        "ros/test_bags.py::test_a_pipe_in_a_bag_holds_no_reader",
        hangs=True,
    ),
    Control(
        "an export from the year 9999",
        "kit/school/progress_export.py",
        "        time.year not in YEARS\n",
        "        time.year < 0\n",
        "school/test_progress.py::test_an_entry_from_another_century_is_refused",
    ),
    Control(
        "a folder of a workspace that everybody may enter",
        "kit/workspace.py",
        "    folder.mkdir(mode=0o700, parents=True, exist_ok=True)\n    status = folder.stat()\n",
        "    if not folder.exists():\n        folder.mkdir(parents=True)\n        return\n    status = folder.stat()\n",
        "test_neighbours.py::test_a_neighbour_reads_no_workspace",
    ),
    Control(
        "a file that everybody reads whatever the umask is",
        "kit/workspace.py",
        "                if follows_links:\n                    with suppress(FileNotFoundError):\n",
        "                os.fchmod(handle, 0o644)\n                if follows_links:\n                    with suppress(FileNotFoundError):\n",
        "test_neighbours.py::test_a_file_has_the_mode_of_the_umask_and_keeps_its_own",
    ),
    Control(
        "a training of nothing",
        "lessons/12-training-strategies/stop/assignment.yaml",
        "    title: It keeps what it promises\n    after: reliable\n",
        "    title: It keeps what it promises\n",
        "test_every_lesson.py::test_every_work_loses_what_it_was_written_for[12-training-strategies-stop]",
    ),
    Control(
        "feedback of an action that is always the same",
        "lessons/31-actions/turner/assignment.yaml",
        "    with: {turned: 0, least: 10}\n",
        "    with: {turned: 0, least: 10}\n    share: {none: 20, full: 10}\n",
        "test_every_lesson.py::test_every_work_loses_what_it_was_written_for[31-actions-turner]",
    ),
)  # fmt: skip


class Seen(Enum):
    """What was seen of a control."""

    FAILS = "fails without it"
    PASSES = "PASSES WITHOUT IT"
    FAILS_ALWAYS = "FAILS WITH IT TOO"
    TOO_LONG = "NO END WITHOUT IT"
    BROKEN = "NO PROGRAM WITHOUT IT"
    SKIPPED = "not on this machine"


@contextmanager
def project_copy() -> Iterator[Path]:
    """Yields a folder with a copy of the project, whose files are links."""
    with tempfile.TemporaryDirectory(prefix="kit-control-", ignore_cleanup_errors=True) as name:
        _copy_project(Path(name))
        yield Path(name)


def _copy_project(folder: Path) -> None:
    for name in COPIED:
        source = ROOT / name
        if source.is_dir():
            shutil.copytree(source, folder / name, copy_function=_link)  # with what has been compiled
        elif source.exists():
            _link(source, folder / name)


def see(control: Control, folder: Path) -> Seen:
    """Runs the control's test in a copy of the project, with its defence and without; what was taken away is there again then."""
    changed = folder / control.file
    text = changed.read_text("utf-8")
    if text.count(control.defence) != 1:
        raise ValueError(f"{control.file} has changed: {control.name} takes nothing away")
    began = time.monotonic()
    code, output = _run(control, folder, LIMIT_S)
    taken_s = time.monotonic() - began
    if code != 0:
        return Seen.FAILS_ALWAYS
    if "passed" not in output:
        return Seen.SKIPPED
    changed.unlink()
    try:
        changed.write_text(text.replace(control.defence, control.without), "utf-8")
        code, output = _run(control, folder, max(HANG_S, 3 * taken_s) if control.hangs else LIMIT_S)
    finally:
        changed.unlink()
        _link(ROOT / control.file, changed)
    if code is None:
        return Seen.FAILS if control.hangs else Seen.TOO_LONG
    if BROKEN.search(output):
        return Seen.BROKEN
    return Seen.FAILS if code == 1 else Seen.PASSES


def _link(source: str | Path, target: str | Path) -> None:
    """Links a file, or copies it to another file system."""
    try:
        os.link(source, target)
    except OSError:
        shutil.copy2(source, target)


def _run(control: Control, folder: Path, limit_s: float) -> tuple[int | None, str]:
    """Returns the exit code of the control's test in a copy of the project, None where it does not end; and what it printed."""
    command = [sys.executable, "-m", "pytest", "-q", "-x", "-p", "no:xdist", "-p", "no:cacheprovider"]
    command += ["--timeout=0", "-m", "long or not long", f"tests/{control.test}"]
    environment = {**os.environ, "PYTHONPATH": str(folder), "PYTHONDONTWRITEBYTECODE": "1"}
    try:
        done = subprocess.run(
            command, cwd=folder, env=environment, capture_output=True, timeout=limit_s, check=False, text=True
        )
    except subprocess.TimeoutExpired:
        return None, ""
    return done.returncode, done.stdout


def tried(words: Sequence[str] = ()) -> Iterator[tuple[Control, Seen]]:
    """Yields each control whose name holds one of the words, with what was seen of it."""
    with project_copy() as folder:
        for control in CONTROLS:
            if not words or any(word in control.name for word in words):
                yield control, see(control, folder)


def main() -> int:
    parser = argparse.ArgumentParser(prog="python -m tests.grader.controls", description=__doc__)
    parser.add_argument("words", nargs="*", help="words in the names of those to try")
    wrong = 0
    for control, seen in tried(parser.parse_args().words):
        print(f"{seen.value:<21} {control.name}: {control.test}", flush=True)
        wrong += seen not in (Seen.FAILS, Seen.SKIPPED)
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
