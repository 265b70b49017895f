"""The form for a new training: task, cases, algorithm, preset, reward, seed."""

from __future__ import annotations

import hashlib
import json
from asyncio import to_thread
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any, ClassVar, Final

from textual import events, work
from textual.app import ComposeResult
from textual.binding import BindingType
from textual.containers import Horizontal

from kit.dialogue.actions import ScreenActions
from kit.dialogue.dialogue import Panel
from kit.dialogue.screen_action import ScreenAction
from kit.document.blocks import Block, labelled_table
from kit.document.rows import MARGIN, at_both_edges, lines_shown, row
from kit.plain_text import counted
from kit.tui.rows.key_rows import bindings, footer
from kit.tui.rows.panel_rows import panel_rows
from kit.tui.rows.setting_rows import settings
from kit.tui.screens.dialogs import HelpDialog, MessageDialog
from kit.tui.screens.picker import Picker, PickerItem
from kit.tui.textual_patches import ActivePaintScreen
from kit.tui.widgets.task_preview import TaskPreview
from kit.tui.widgets.text_rows import TextRows

if TYPE_CHECKING:
    from kit.learning.training.run_config import PresetName, RunConfig
    from kit.learning.training.runs import TrainingRun
    from kit.learning.training.training_sweep import TrainingSweep
    from kit.tui.theme import Theme

WIDE: Final = 110
"""Columns from which on the task stands beside the settings."""
LIST_WIDTH, WIDEST_LIST = 60, 84
"""Columns of the settings, then."""
FIRST_TASK: Final = "turn"
"""The task that is offered first."""
DISSERTATION: Final = " dissertation"
"""Instead of the name of a task, of which none begins with a blank."""
ALL: Final = "all"
OWN_REWARD: Final = "the task's own"
PRESETS: Final[Mapping[PresetName, str]] = {
    "kit": "the kit's own: learns fast and reliably",
    "seed": "the dissertation's",
    "seed-text": "as its text has it",
}
SEEDS: Final = 100
SWEEPS: Final = "sweeps"
"""The folder of the workspace in which `kit sweep` keeps its results."""
ABOUT: Final = {
    "task": "what is to be learned: a task of the kit's, or a file of your own",
    "cases": "all of them, or some: choosing one adds it or takes it away",
    "algorithm": "how it is learned",
    "preset": "the algorithm's settings",
    "reward": "what a step earns: a file of yours needs a function reward()",
    "seed": "where random numbers start: the same seed, the same training",
    "trainings": "how many, each with the next seed; more than one is a sweep",
}
SWEEP_SIZES: Final = {
    1: "one training, to be watched",
    3: "a sweep",
    5: "a sweep",
    10: "a sweep",
    20: "a sweep",
}
TEST_EPISODES: Final = 200
"""Episodes per case in the test at the end of each training of a sweep."""


@dataclass(frozen=True, slots=True)
class TrainingChoices:
    """What has been chosen so far."""

    task: str = FIRST_TASK
    """A name, or the path of a file."""
    cases: tuple[str, ...] = ()
    """None: all."""
    algorithm: str = "ppo"
    preset: PresetName = "kit"
    reward: str = ""
    """The path of a file; empty: the task's own."""
    seed: int = 0
    trainings: int = 1

    def entries(self) -> list[tuple[str, str, str]]:
        """Name, value and meaning of each setting."""
        values = {
            "task": self.task,
            "cases": ", ".join(self.cases) or ALL,
            "algorithm": self.algorithm,
            "preset": f"{self.preset}, {PRESETS[self.preset]}",
            "reward": self.reward or OWN_REWARD,
            "seed": str(self.seed),
            "trainings": str(self.trainings) if self.trainings == 1 else f"{self.trainings}, a sweep",
        }
        return [(name, value, ABOUT[name]) for name, value in values.items()]

    def config(self) -> RunConfig:
        """The configuration of a run."""
        from kit.learning.tasks.task_spec import TaskSpec
        from kit.learning.training.run_config import RunConfig

        return RunConfig(
            TaskSpec(self.task, self.cases),
            self.algorithm,
            self.preset,
            self.seed,
            reward_file=self.reward or None,
        )

    def sweep_configs(self) -> list[RunConfig]:
        """The configurations of a sweep: the same from several seeds."""
        config = self.config()
        return [replace(config, seed=self.seed + number) for number in range(self.trainings)]


class NewTrainingScreen(ActivePaintScreen["TrainingRun | TrainingSweep | None"]):
    """Returns the run, or the sweep, which is being trained already; None if none was begun."""

    AUTO_FOCUS = ""
    screen_actions = ScreenActions(
        "new training",
        ("choose", "change", "begin", "help", "back"),
        own=(
            ScreenAction("change", "Enter", "change", "change the selected setting", (("enter", "open"),)),
        ),
    )  # fmt: skip
    BINDINGS: ClassVar[list[BindingType]] = bindings(screen_actions)
    HORIZONTAL_BREAKPOINTS = [(0, "-narrow"), (WIDE, "-wide")]  # noqa: RUF012 - Textual's own attribute
    DEFAULT_CSS = """
    NewTrainingScreen { layout: vertical; }
    NewTrainingScreen #heading, NewTrainingScreen #note, NewTrainingScreen #keys { height: 1; }
    NewTrainingScreen #middle { height: 1fr; }
    NewTrainingScreen TaskPreview { display: none; }
    NewTrainingScreen.-wide TaskPreview { display: block; width: 1fr; }
    """

    def __init__(self, theme: Theme, runs: Path, task: str = FIRST_TASK) -> None:
        """``task``: the one that is offered first."""
        super().__init__()
        self._theme = theme
        self._runs = runs
        self.settings = TrainingChoices(task)
        self._preset: Sequence[Block] = ()
        """What the preset sets, as it was read last, and for which choices."""
        self._preset_of: TrainingChoices | None = None
        self._chosen = 0
        self._note = ""

    def compose(self) -> ComposeResult:
        yield TextRows(id="heading")
        with Horizontal(id="middle"):
            yield TextRows(id="body")
            yield TaskPreview(self._theme, self._runs)
        yield TextRows(id="note")
        yield TextRows(id="keys")

    def on_resize(self, event: events.Resize) -> None:
        self.call_after_refresh(self._show)

    def _show(self) -> None:
        width = self.size.width
        preview = self.query_one(TaskPreview)
        beside = max(LIST_WIDTH, min(width * 2 // 5, WIDEST_LIST)) if preview.display else width
        self.query_one("#body").styles.width = beside if preview.display else None
        rows = settings(self.settings.entries(), self._chosen, beside)
        if preview.display:
            preview.tell(self.settings)
        room = max(1, self.size.height - 3)
        if self.settings != self._preset_of and preview.display:
            self._preset_of = self.settings
            self._read_preset(self.settings)
        if self._preset and preview.display:
            panel = Panel(f"what preset {self.settings.preset} sets", tuple(self._preset))
            rows += panel_rows([panel], beside - MARGIN, room - len(rows))
        chosen = next(number for number, each in enumerate(rows) if each and each[0][0] == ">")
        first = max(0, min(chosen - room // 2, len(rows) - room))
        where = lines_shown(first, min(room, len(rows)), len(rows))
        heading = at_both_edges(row(("A new training", "title")), row((where, "dim")), beside)
        self.query_one("#heading", TextRows).show([heading])
        self.query_one("#body", TextRows).show(rows[first : first + room])
        self.query_one("#note", TextRows).show([row((self._note[:width], "dim"))])
        self.query_one("#keys", TextRows).show([footer(self.screen_actions, width)])

    @work(exclusive=True, group="preset")
    async def _read_preset(self, choices: TrainingChoices) -> None:
        try:
            self._preset = await to_thread(_preset_blocks, choices)
        except Exception:  # noqa: BLE001 - a task or an algorithm that does not fit, which starting it tells
            self._preset = ()
        if self.is_attached:
            self._show()

    # Keys

    def action_choose(self, columns: int, rows: int) -> None:
        self._chosen = max(0, min(self._chosen + rows, len(ABOUT) - 1))
        self._show()

    @work(exclusive=True)
    async def action_open(self) -> None:
        """Changes the chosen setting."""
        name = list(ABOUT)[self._chosen]
        try:
            await getattr(self, f"_choose_{name}")()
        except Exception as error:  # noqa: BLE001 - a damaged task file, a folder that is away: all of it is told
            self.app.push_screen(MessageDialog("That did not work", str(error)))
        self._show()

    async def _pick(self, title: str, items: list[PickerItem], chosen: str) -> str | None:
        return await self.app.push_screen_wait(Picker(title, items, chosen))

    async def _choose_task(self) -> None:
        items, variants = await to_thread(_task_items, self._folders())
        chosen = await self._pick("Task", items, self.settings.task)
        if chosen == DISSERTATION:
            chosen = await self._pick("As in the dissertation", variants, self.settings.task)
        if chosen is not None and chosen != self.settings.task:
            self.settings = replace(self.settings, task=chosen, cases=())

    async def _choose_cases(self) -> None:
        """Asks for cases one after the other, until Esc."""
        names = await to_thread(_case_items, self.settings.task)
        while True:
            cases = self.settings.cases
            items = [PickerItem(ALL, f"{'*' if not cases else ' '} {ALL}", "every case of the task")]
            items += [
                PickerItem(name, f"{'*' if name in cases else ' '} {name}", text) for name, text in names
            ]
            chosen = await self._pick("Cases: Enter marks, Esc is done", items, cases[-1] if cases else ALL)
            if chosen is None:
                return
            kept = [name for name, _ in names if (name in cases) != (name == chosen)]
            self.settings = replace(self.settings, cases=() if chosen == ALL else tuple(kept))
            self._show()

    async def _choose_algorithm(self) -> None:
        from kit.learning.training.algorithms import ALGORITHMS

        items = [
            PickerItem(each.name, each.name, f"{each.title} ({each.library})") for each in ALGORITHMS.values()
        ]
        chosen = await self._pick("Algorithm", items, self.settings.algorithm)
        self.settings = replace(self.settings, algorithm=chosen or self.settings.algorithm)

    async def _choose_preset(self) -> None:
        items = [PickerItem(name, name, text) for name, text in PRESETS.items()]
        chosen = await self._pick("Preset", items, self.settings.preset)
        for preset in PRESETS:
            if chosen == preset:
                self.settings = replace(self.settings, preset=preset)

    async def _choose_reward(self) -> None:
        items = await to_thread(_reward_items, self._folders())
        chosen = await self._pick("Reward", items, self.settings.reward or OWN_REWARD)
        if chosen is not None:
            self.settings = replace(self.settings, reward="" if chosen == OWN_REWARD else chosen)

    async def _choose_seed(self) -> None:
        items = [PickerItem(str(number), str(number)) for number in range(SEEDS)]
        chosen = await self._pick("Seed", items, str(self.settings.seed))
        self.settings = replace(self.settings, seed=int(chosen or self.settings.seed))

    async def _choose_trainings(self) -> None:
        items = [PickerItem(str(count), str(count), text) for count, text in SWEEP_SIZES.items()]
        chosen = await self._pick("Trainings", items, str(self.settings.trainings))
        self.settings = replace(self.settings, trainings=int(chosen or self.settings.trainings))

    def _folders(self) -> tuple[Path, ...]:
        """The workspace, and the folder that the kit was started in unless that is one of a whole system."""
        here = Path.cwd()
        return (self._runs.parent, *(() if here in (Path("/"), Path.home()) else (here,)))

    @work(exclusive=True)
    async def action_begin(self) -> None:
        self._note = "checking task, worlds and reward; the training screen opens by itself ..."
        self._show()
        try:
            begun = await to_thread(self._begin)
        except Exception as error:  # noqa: BLE001 - torch missing, a full disk, a wrong file: all of it is told
            self._note = ""
            if not self.is_current:
                return
            self.app.push_screen(MessageDialog("This cannot be trained", str(error)))
            self._show()
            return
        if self.is_current:  # else it was left meanwhile: the training is in the list
            self.dismiss(begun)

    def _begin(self) -> TrainingRun | TrainingSweep:
        if self.settings.trainings == 1:
            return begin_training(self._runs, self.settings.config())
        return begin_sweep(self._runs.parent / SWEEPS, self.settings.sweep_configs())

    def action_help(self) -> None:
        self.app.push_screen(HelpDialog("A new training", self.screen_actions, tuple(ABOUT.items())))

    def action_back(self) -> None:
        self.dismiss(None)


def begin_training(folder: Path, config: RunConfig) -> TrainingRun:
    """Checks everything that can be wrong before anything is written, and starts the training. Raises what is wrong."""
    from kit.learning.training.run_check import check_run_config
    from kit.learning.training.run_folders import create_run
    from kit.learning.training.worker import start_worker

    check_run_config(config)
    run = create_run(folder, config)
    start_worker(run)
    return run


def begin_sweep(folder: Path, configs: Sequence[RunConfig]) -> TrainingSweep:
    """The same for a sweep, in a folder of its own inside ``folder``: one that was begun before with the same goes on."""
    from kit.learning.training.run_check import check_run_config
    from kit.learning.training.sweep_worker import start_sweep
    from kit.learning.training.training_sweep import TrainingSweep

    first = configs[0]
    check_run_config(first)
    told = json.dumps([config.as_dict() for config in configs], sort_keys=True).encode()
    name = f"{first.choice.name}-{first.algorithm}-{len(configs)}-{hashlib.sha256(told).hexdigest()[:6]}"
    sweep = TrainingSweep.prepare(folder / name, configs, TEST_EPISODES)
    start_sweep(sweep)
    return sweep


def _preset_blocks(choices: TrainingChoices) -> Sequence[Block]:
    """What the preset sets for this task and algorithm. The learning side takes a moment to import."""
    from kit.learning.training.algorithms import find_algorithm
    from kit.learning.training.training import resolve_preset

    preset = resolve_preset(choices.config())
    has_network = find_algorithm(choices.algorithm).family != "table"
    layers = [("hidden layers", " ".join(map(str, preset.layers)))] if has_network else []
    numbers = [
        (name, number) for name in preset.setting_types() if (number := preset.number_of(name)) is not None
    ]
    about = [
        ("steps", f"{preset.steps:,} at most"),
        ("worlds", f"{preset.worlds} at once"),
        *layers,
        *numbers,
    ]
    return [labelled_table(about, is_tight=True)]


def _task_items(folders: tuple[Path, ...]) -> tuple[list[PickerItem], list[PickerItem]]:
    """The user's own tasks, the kit's, and a line for those as in the dissertation; and these. In another thread: the learning
    side takes a moment to import."""
    from kit.learning.tasks.catalogue import dissertation_tasks, first_tasks
    from kit.learning.tasks.own_files import own_task_files

    own = [
        PickerItem(str(file), _short_name(file), f"your own, in {file.parent}")
        for file in own_task_files(folders)
    ]
    first, variants = (
        [PickerItem(task.name, task.name, task.summary) for task in tasks]
        for tasks in (first_tasks(), dissertation_tasks())
    )
    text = f"{counted(len(variants), 'task')} to repeat its numbers: its rewards, actions and endings"
    names = " ".join(each.name for each in variants)
    return [*own, *first, PickerItem(DISSERTATION, "dissertation", text, names)], variants


def _short_name(file: Path) -> str:
    """A task's file by the name that a user gave it."""
    return file.parent.name if file.stem == "task" else file.stem


def _reward_items(folders: tuple[Path, ...]) -> list[PickerItem]:
    from kit.learning.authoring.own_rewards import own_reward_files

    files: list[Any] = list(own_reward_files(folders))
    return [
        PickerItem(OWN_REWARD, OWN_REWARD),
        *(PickerItem(str(file), file.name, f"in {file.parent}") for file in files),
    ]


def _case_items(task: str) -> list[tuple[str, str]]:
    """Groups of cases, then single ones, with what each is."""
    from kit.learning.tasks.catalogue import find_task

    cases = [case for _, case in find_task(task).map_cases()]
    groups: dict[str, list[str]] = {}
    for case in cases:
        if case.group:
            groups.setdefault(case.group, []).append(case.name)
    return [
        *((group, f"group: {', '.join(names)}") for group, names in groups.items()),
        *((case.name, f"of group {case.group}" if case.group else "") for case in cases),
    ]
