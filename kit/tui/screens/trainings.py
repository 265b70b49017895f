"""The trainings there are: look at one, begin one, test and compare them, rename and delete them."""

from __future__ import annotations

from asyncio import to_thread
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, ClassVar, Final

from textual import events, work
from textual.app import ComposeResult
from textual.binding import BindingType
from textual.containers import Horizontal, Vertical
from textual.geometry import Size

from kit.dialogue.actions import ScreenActions
from kit.dialogue.screen_action import ScreenAction, letter
from kit.document.blocks import Block, Text
from kit.document.rows import at_both_edges, row
from kit.plain_files import foreign_part
from kit.plain_text import counted, format_size
from kit.tui.rows import training_rows
from kit.tui.rows.key_rows import bindings, footer
from kit.tui.rows.training_list_rows import about_run, no_trainings, training_list
from kit.tui.screens.dialogs import HelpDialog, MessageDialog, NameDialog
from kit.tui.screens.new_training import FIRST_TASK, SWEEPS, NewTrainingScreen, TrainingChoices
from kit.tui.screens.picker import Picker, PickerItem
from kit.tui.screens.text_screen import TextScreen
from kit.tui.screens.training import TrainingScreen
from kit.tui.theme import Theme
from kit.tui.widgets.task_preview import TaskPreview
from kit.tui.widgets.text_rows import RowsScreen, TextRows
from kit.tui.widgets.training_preview import TrainingPreview

if TYPE_CHECKING:
    from kit.learning.tasks.learning_task import LearningTask
    from kit.learning.training.run_status import RunStatus
    from kit.learning.training.run_upkeep import RunOverview
    from kit.learning.training.runs import TrainingRun

POLL_S: Final = 2.0
"""Between two looks at the folder of runs."""
EPISODES: Final = 200
"""Episodes per case in a test from this screen; `kit evaluate --episodes` takes any number."""
SWEEP_EPISODES: Final = 50
CURVE_ROWS: Final = 14
LEAST_ROWS_BELOW: Final = 9
"""Below the list, for more of the chosen run to be shown there."""


class TrainingsScreen(RowsScreen[None]):
    """Reads the runs again and again while it is open, in another thread."""

    AUTO_FOCUS = ""
    screen_actions = ScreenActions(
        "trainings",
        (
            "choose", "open", "begin", "evaluate", "mark_run", "compare", "sweeps", "robustness", "rename",
            "delete_run", "help", "back",
        ),
        own=(
            letter("evaluate", "e", "evaluate", "test the selected run on new episodes"),
            ScreenAction("mark_run", "Space", "mark", "mark a run, to compare the marked ones", (("space", "mark"),)),
            letter("compare", "o", "compare", "compare the marked runs on the same episodes"),
            letter("sweeps", "l", "sweeps", "show the tables of kit sweep: many seeds compared"),
            letter("robustness", "k", "robustness", "show the selected run's success under disturbances"),
            letter("rename", "a", "rename", "rename the selected run"),
            ScreenAction("delete_run", "d Del", "delete", "delete the selected run; asks first", (("d,delete", "delete"),)),
        ),
    )  # fmt: skip
    BINDINGS: ClassVar[list[BindingType]] = bindings(screen_actions)
    DEFAULT_CSS = """
    TrainingsScreen { layout: vertical; }
    TrainingsScreen #heading, TrainingsScreen #note, TrainingsScreen #keys { height: 1; }
    TrainingsScreen #middle { height: 1fr; }
    TrainingsScreen #left { width: 1fr; }
    TrainingsScreen #preview { width: 1fr; padding: 0 0 0 2; display: none; }
    TrainingsScreen #details { height: 1fr; padding: 1 0 0 3; display: none; }
    TrainingsScreen.-roomy #left, TrainingsScreen.-wide #left { width: 68; }
    TrainingsScreen.-roomy #preview, TrainingsScreen.-wide #preview { display: block; }
    TrainingsScreen.-short #body { height: auto; }
    TrainingsScreen.-short.-roomy #details, TrainingsScreen.-short.-wide #details { display: block; }
    TrainingsScreen.-short.-narrow #middle { layout: vertical; }
    TrainingsScreen.-short.-narrow #left { height: auto; }
    TrainingsScreen.-short.-narrow #preview { display: block; height: 1fr; padding: 1 0 0 0; }
    TrainingsScreen TaskPreview { display: none; width: 1fr; }
    TrainingsScreen.-empty #left { width: 1fr; }
    TrainingsScreen.-empty #preview { display: none; }
    TrainingsScreen.-empty.-roomy #left { width: 76; }
    TrainingsScreen.-empty.-wide #left { width: 118; }
    TrainingsScreen.-empty.-roomy TaskPreview, TrainingsScreen.-empty.-wide TaskPreview { display: block; }
    """
    HORIZONTAL_BREAKPOINTS = [(0, "-narrow"), (110, "-roomy"), (160, "-wide")]  # noqa: RUF012 - Textual's own

    def __init__(self, theme: Theme, runs: Path) -> None:
        super().__init__()
        self._theme = theme
        self._runs = runs
        self._overviews: Sequence[RunOverview] | None = None
        self._tasks: Sequence[LearningTask] = ()
        """What can be learned; read where there are no trainings."""
        self._chosen = 0
        self._wanted: str | None = None
        """The run to choose once it is in the list."""
        self._marked: set[str] = set()
        self._note = ""
        self._preview = TrainingPreview(theme, id="preview")
        self._detailed: tuple[RunStatus | None, Size] = (None, Size())
        """What is told below the list: of what, and in how much room."""
        self._first_task = TaskPreview(theme, runs, is_overview=True)
        """What a first training would learn, unless another task is chosen."""
        self.add_class("-empty")

    def compose(self) -> ComposeResult:
        yield TextRows(id="heading")
        with Horizontal(id="middle"):
            with Vertical(id="left"):
                yield TextRows(id="body")
                yield TextRows(id="details")
            yield self._preview
            yield self._first_task
        yield TextRows(id="note")
        yield TextRows(id="keys")

    def on_mount(self) -> None:
        self._read()
        self.set_interval(POLL_S, self._read)

    def on_resize(self, event: events.Resize) -> None:
        self.call_after_refresh(self._show)

    def on_screen_resume(self) -> None:
        self._read()

    def on_screen_suspend(self) -> None:
        self._preview.follow(None)

    @work(exclusive=True, group="reading")
    async def _read(self) -> None:
        if not self.is_active:
            return
        overviews = self._overviews
        try:
            overviews = await to_thread(_read_runs, self._runs)
            if not overviews and not self._tasks:
                self._tasks = await to_thread(_read_tasks)
        except OSError as error:  # a network drive that is away comes back
            self._note = str(error)
        name = self._wanted or self._chosen_name  # asked now: keys were pressed while the folder was read
        self._overviews = overviews
        names = [each.run.name for each in self._overviews or ()]
        if self._wanted in names:
            self._wanted = None
        self._chosen = names.index(name) if name in names else max(0, min(self._chosen, self._last))
        self._marked &= set(names)
        self._show()

    def _show(self) -> None:
        width, runs = self.size.width, self._overviews
        room, columns = max(2, self.size.height - 3), self.query_one("#left", Vertical).size.width or width
        listed = training_list(runs, self._chosen, self._marked, columns, room) if runs else []
        self.set_class(not runs, "-empty")
        self.set_class(bool(runs) and room - len(listed) >= LEAST_ROWS_BELOW, "-short")
        count = (
            counted(len(runs), "run") if runs else counted(len(self._tasks), "task") if self._tasks else ""
        )
        self._rows("heading").show([at_both_edges(row(("Trainings", "title")), row((count, "dim")), width)])
        if runs is None:
            self._rows("body").show([row((" reading ...", "dim"))])
        else:
            self._rows("body").show(listed or no_trainings(self._tasks, self._chosen, columns, room))
        if self._first_task.display:
            self._first_task.tell(TrainingChoices(self._first_task_name))
        self.call_after_refresh(self._follow_chosen)  # once it is decided whether the preview is displayed
        total = sum(each.disk_bytes for each in runs or ())
        about = about_run(self._chosen_run, total, width)
        self._rows("note").show([row((self._note[:width], "warn")) if self._note else about])
        self._rows("keys").show([footer(self.screen_actions, width, without=self.unavailable_actions)])

    @property
    def unavailable_actions(self) -> tuple[str, ...]:
        """What needs a training that there is not."""
        of_run = "open", "evaluate", "mark_run", "compare", "robustness", "rename", "delete_run"
        return () if self._overviews else of_run

    def _follow_chosen(self) -> None:
        chosen = self._chosen_run
        if self.is_active:
            self._preview.follow(chosen.run if chosen is not None and self._preview.display else None)
            self._show_details()

    def on_training_preview_arrived(self) -> None:
        self._show_details()

    def _show_details(self) -> None:
        """Below a short list: the first page of what the chosen run's own screen has in its panel."""
        details, status = self._rows("details"), self._preview.status
        room = details.content_size
        if (status, room) != self._detailed:
            self._detailed = status, room
            details.show(training_rows.pages(status, room.width, room.height)[0] if status and room else [])

    @property
    def _last(self) -> int:
        """The number of the last entry of the list: of the runs, or of the tasks where there are none."""
        return len(self._overviews or self._tasks) - 1

    @property
    def _first_task_name(self) -> str:
        """The task that a first training would learn, unless another one is chosen there."""
        return self._tasks[self._chosen].name if self._tasks and not self._overviews else FIRST_TASK

    @property
    def _chosen_run(self) -> RunOverview | None:
        runs = self._overviews
        return runs[self._chosen] if runs else None

    @property
    def _chosen_name(self) -> str | None:
        return None if self._chosen_run is None else self._chosen_run.run.name

    # Keys

    def action_choose(self, columns: int, rows: int) -> None:
        self._chosen = max(0, min(self._chosen + rows, self._last))
        self._show()

    def action_open(self) -> None:
        if self._chosen_run is not None:
            self._look_at(self._chosen_run.run)

    @work(exclusive=True, group="screens")
    async def _look_at(self, run: TrainingRun) -> None:
        await self.app.push_screen_wait(TrainingScreen(self._theme, run))

    @work(exclusive=True, group="screens")
    async def action_begin(self) -> None:
        from kit.learning.training.runs import TrainingRun

        begun = await self.app.push_screen_wait(
            NewTrainingScreen(self._theme, self._runs, self._first_task_name)
        )
        if isinstance(begun, TrainingRun):
            self._wanted = begun.name
            await self.app.push_screen_wait(TrainingScreen(self._theme, begun))
        elif begun is not None:
            self._note = f"{begun.folder.name} trains: f shows how far it is"
            self._show()

    def action_mark(self) -> None:
        if self._chosen_name is not None:
            self._marked ^= {self._chosen_name}
            self._show()

    def action_evaluate(self) -> None:
        if self._chosen_run is not None:
            run = self._chosen_run.run
            self._show_when_made(
                f"testing {run.name} ...", f"Test of {run.name}", lambda columns: _test_rows(run, columns)
            )

    def action_compare(self) -> None:
        marked = [each.run for each in self._overviews or () if each.run.name in self._marked]
        if len(marked) < 2:
            self._note = "Mark two runs or more with Space: they are compared on the same episodes."
            self._show()
            return
        self._show_when_made(
            f"testing {counted(len(marked), 'run')} ...",
            "Comparison",
            lambda columns: _comparison_rows(marked, self._theme, columns),
        )

    @work(exclusive=True, group="screens")
    async def action_sweeps(self) -> None:
        items = await to_thread(_sweep_items, self._runs.parent / SWEEPS)
        if not items:
            text = "No sweeps yet: the same training with several seeds, in one table. Press t to start one."
            self.app.push_screen(MessageDialog("Sweeps", text))
            return
        chosen = await self.app.push_screen_wait(Picker("Sweeps", items))
        if chosen is not None:
            await self._open_sweep(self._runs.parent / SWEEPS / chosen)

    async def _open_sweep(self, folder: Path) -> None:
        """Shows the sweep's table, or stops it or has it go on, where there is something to stop or to go on with."""
        from kit.learning.training.sweep_worker import start_sweep
        from kit.learning.training.training_sweep import TrainingSweep

        sweep = TrainingSweep(folder)
        change = "stop" if sweep.is_active else "go on" if sweep.waiting() else ""
        wish: str | None = "table"
        if change:
            items = [PickerItem("table", "show its table", "what has been trained so far")]
            items.append(PickerItem(change, change, "the trainings that have no result yet"))
            wish = await self.app.push_screen_wait(Picker(folder.name, items))
        if wish == "table":
            self._show_when_made(
                f"reading {folder.name} ...",
                f"Sweep {folder.name}",
                lambda columns: _sweep_table(folder, columns),
            )
        elif wish is not None:
            await self._do(sweep.stop if wish == "stop" else lambda: start_sweep(sweep))

    def action_robustness(self) -> None:
        if self._chosen_run is not None:
            run = self._chosen_run.run
            self._show_when_made(
                f"testing {run.name} under every disturbance; this takes a while ...",
                f"Robustness of {run.name}",
                lambda columns: _robustness_rows(run, self._theme, columns),
            )

    @work(exclusive=True, group="work")
    async def _show_when_made(self, note: str, title: str, make: Callable[[int], list[str]]) -> None:
        """Does long work in another thread, and shows its rows."""
        self._note = note
        self._show()
        try:
            rows = await to_thread(make, self.size.width - 2)
        except Exception as error:  # noqa: BLE001 - no policy yet, a damaged one, a task that is gone: all of it is told
            self.app.push_screen(MessageDialog("That did not work", str(error)))
        else:
            if self.is_attached:
                self.app.push_screen(TextScreen(title, [row(f" {line}") for line in rows]))
        self._note = ""
        self._show()

    @work(exclusive=True, group="screens")
    async def action_rename(self) -> None:
        if self._chosen_run is None:
            return
        run = self._chosen_run.run
        name = await self.app.push_screen_wait(NameDialog(f"Rename {run.name}", run.name))
        if name is not None and name != run.name:
            from kit.learning.training.run_upkeep import rename_run

            await self._do(lambda: rename_run(run, name), wanted=name)

    @work(exclusive=True, group="screens")
    async def action_delete(self) -> None:
        if self._chosen_run is None:
            return
        from kit.learning.training.run_upkeep import delete_run

        run, size = self._chosen_run.run, format_size(self._chosen_run.disk_bytes)
        choices = [
            PickerItem("keep", "keep it"),
            PickerItem("delete", "delete it", f"{size}: its policies, its curves, its checkpoints"),
        ]
        if await self.app.push_screen_wait(Picker(f"Delete {run.name}?", choices)) == "delete":
            await self._do(lambda: delete_run(run))

    async def _do(self, change: Callable[[], object], wanted: str | None = None) -> None:
        """Changes something in another thread, and chooses the run named `wanted` once it is in the list."""
        from kit.learning.training.run_config import RunError

        self._wanted = wanted
        try:
            await to_thread(change)
        except (RunError, OSError) as error:
            self._wanted = None
            self.app.push_screen(MessageDialog("That did not work", str(error)))
        self._read()

    def action_help(self) -> None:
        self.app.push_screen(HelpDialog("Trainings", self.screen_actions))

    def action_back(self) -> None:
        self.dismiss()


# In another thread: the learning side takes a moment to import, and files may be far away


def _read_runs(folder: Path) -> Sequence[RunOverview]:
    from kit.learning.training.run_folders import list_runs
    from kit.learning.training.run_upkeep import read_overviews

    return read_overviews(list_runs(folder))


def _read_tasks() -> Sequence[LearningTask]:
    from kit.learning.tasks.catalogue import first_tasks

    return first_tasks()


def _test_rows(run: TrainingRun, columns: int) -> list[str]:
    from kit.document.layout import Page, lines_of
    from kit.learning.policies.evaluation import evaluate_on
    from kit.learning.policies.seeds import derive_seed

    policy = run.policy()
    result = evaluate_on(policy.trained_on.resolve(), policy, EPISODES, derive_seed(1, "evaluate"))
    head = f"trained on {policy.trained_on.title}, {policy.steps:,} steps"
    ways = Text(f"`kit evaluate {run.name} --paths 5` draws its ways.")
    return lines_of([Text(head), result.table(), ways], Page(width=columns))


def _comparison_rows(runs: Sequence[TrainingRun], theme: Theme, columns: int) -> list[str]:
    from kit.document.layout import Page, lines_of
    from kit.learning.policies.evaluation import Evaluator
    from kit.learning.policies.seeds import derive_seed
    from kit.learning.training.run_text import comparison_tables
    from kit.learning.training.run_upkeep import draw_test_curves

    results = {}
    for run in runs:
        policy = run.policy()
        evaluator = Evaluator(policy.trained_on.resolve())
        results[run.name] = evaluator.test(policy, EPISODES, derive_seed(1, "evaluate"))
    curves = draw_test_curves(runs, columns, CURVE_ROWS, theme.encoder)
    blocks: list[Block] = [*comparison_tables(results), Text("success in the tests of the training")]
    return [*lines_of(blocks, Page(width=columns)), *curves]


def _sweep_items(folder: Path) -> list[PickerItem]:
    """The sweeps that `kit sweep` keeps, the last one first."""
    from kit.learning.training.training_sweep import TrainingSweep

    manifests = sorted(
        folder.glob("[!.]*/manifest.json"), key=lambda file: file.stat().st_mtime, reverse=True
    )
    items = []
    for file in manifests:
        if foreign_part(file.parent):  # it would be written to; `kit sweep` says why it is left out
            continue
        sweep = TrainingSweep(file.parent)
        total, waiting = len(sweep.entries()), len(sweep.waiting())
        state = ", training" if sweep.is_active else ""
        items.append(
            PickerItem(file.parent.name, file.parent.name, f"{total - waiting} of {total} trained{state}")
        )
    return items


def _sweep_table(folder: Path, columns: int) -> list[str]:
    from kit.document.layout import Page, lines_of, text_blocks
    from kit.learning.training.sweep_table import problems, sweep_rows, sweep_table
    from kit.learning.training.training_sweep import TrainingSweep

    sweep = TrainingSweep(folder)
    return lines_of(
        [sweep_table(sweep_rows(sweep)), Text(""), *text_blocks(problems(sweep))], Page(width=columns)
    )


def _robustness_rows(run: TrainingRun, theme: Theme, columns: int) -> list[str]:
    from kit.document.layout import Page, lines_of
    from kit.learning.policies.seeds import derive_seed
    from kit.learning.policies.sweep import PolicySweep, find_kinds, sweep_blocks

    policy = run.policy()
    sweep = PolicySweep(
        policy,
        policy.trained_on.resolve(),
        find_kinds(()),
        episodes=SWEEP_EPISODES,
        seed=derive_seed(1, "evaluate"),
        journal=run.folder / "sweep.jsonl",
    )
    columns = min(79, columns)
    return lines_of(sweep_blocks(list(sweep.points()), theme.encoder, columns), Page(width=columns))
