"""A graph scene as it is played: the same each time, by the numbers it says, and true of the kit's own nodes."""

from __future__ import annotations

from dataclasses import replace

import pytest

from kit.controllers import find_controller
from kit.render.encode import AsciiEncoder
from kit.render.graph_data import build_graph_data
from kit.ros.graph.snapshot import snapshot
from kit.run.scenario import find_scenario
from kit.run.session import Session
from kit.school.lessons.graph_playback import FRAME_S, MAX_COLUMNS, GraphPlayback, graph_rows
from kit.school.lessons.reading import find_lesson, lesson_names
from kit.school.lessons.records import GraphChannel, GraphScene, LessonStep

TOPIC = GraphChannel("/scan", "/laser", ("/driver", "/counter"), rate=10.0)
SILENT = GraphChannel("/log", "/laser", (), rate=None, times=(1.0, 2.0), asked='"log"')
SERVICE = GraphChannel("/halt", "/driver", ("/robot",), rate=None, times=(0.5,), is_service=True)
SCENE = GraphScene((TOPIC, SILENT, SERVICE), seconds=4.0)
COLUMNS, ROWS = 79, 12


def shown(playback: GraphPlayback) -> str:
    return "\n".join(playback.frame(COLUMNS, ROWS, AsciiEncoder()).rows())


def graph_steps() -> list[LessonStep]:
    return [step for name in lesson_names() for step in find_lesson(name).steps if step.graph is not None]


def test_nothing_moves_and_nothing_is_said_before_it_begins() -> None:
    playback = GraphPlayback(SCENE)
    assert "o" not in shown(playback).replace("/robot", "").replace("/counter", "").replace('"log"', "")
    assert "messages" not in shown(playback)
    assert '"log"' in shown(playback)
    assert "/log" not in shown(playback)
    playback.step()
    assert '"log"' not in shown(playback)


def test_every_place_is_the_same_however_the_time_is_cut() -> None:
    whole, cut = GraphPlayback(SCENE), GraphPlayback(SCENE)
    whole.advance_to(2.0)
    while cut.time_s < 2.0:
        cut.step()
    assert cut.time_s == 2.0
    assert shown(whole) == shown(cut)
    for _ in range(100):
        cut.advance_to(cut.time_s + FRAME_S / 3)
    assert cut.is_over
    whole.advance_to(99.0)
    assert shown(whole) == shown(cut)


def test_messages_are_counted_as_they_are_sent() -> None:
    playback = GraphPlayback(SCENE)
    playback.advance_to(1.5)
    assert playback.describe() == [
        "/scan: 15 messages, each to /driver and /counter",
        "/log: 1 message, no subscriber",
        "/halt: 1 request, answered by /robot",
    ]


def test_what_does_not_arrive_is_marked_once_it_has_begun() -> None:
    lossy = replace(TOPIC, undelivered=("/driver",))
    playback = GraphPlayback(GraphScene((lossy,), seconds=4.0))
    assert "X" not in shown(playback)
    playback.advance_to(2.0)
    assert "X" in shown(playback)
    assert playback.describe() == ["/scan: 20 messages, each to /counter, none to /driver"]
    nobody = GraphPlayback(GraphScene((replace(lossy, receivers=("/driver",)),), seconds=4.0))
    nobody.advance_to(2.0)
    assert nobody.describe() == ["/scan: 20 messages, none to /driver"]


def test_a_request_goes_there_and_its_answer_comes_back() -> None:
    playback = GraphPlayback(GraphScene((SERVICE,), seconds=6.0))
    places = []
    while not playback.is_over:
        playback.step()
        row = shown(playback).splitlines()[0]
        places += [
            at for at, sign in enumerate(row) if sign == "o" and row[at - 1 : at + 2].strip(".>+ ") == "o"
        ]
    turn = places.index(max(places))
    assert places[: turn + 1] == sorted(places[: turn + 1])
    assert places[turn:] == sorted(places[turn:], reverse=True)
    assert len(places[turn:]) > 3


def test_a_picture_grows_up_to_its_largest_width() -> None:
    def drawn(columns: int) -> list[str]:
        return [row.rstrip() for row in GraphPlayback(SCENE).frame(columns, ROWS, AsciiEncoder()).rows()]

    assert drawn(MAX_COLUMNS) == drawn(MAX_COLUMNS + 1) == drawn(3 * MAX_COLUMNS)
    assert drawn(MAX_COLUMNS - 2) != drawn(MAX_COLUMNS)


def test_it_is_still_and_in_words_for_those_who_read_lines() -> None:
    before, after = graph_rows(SCENE, at_end=False), graph_rows(SCENE, at_end=True)
    assert not any("messages" in row for row in before)
    assert any(row.strip() == "/scan: 40 messages, each to /driver and /counter" for row in after)
    assert after[-1] == "That is after 4 s."
    assert all(row.isascii() and len(row) < 80 for row in (*before, *after))


def test_lessons_on_nodes_have_a_graph_that_moves() -> None:
    names = ("01-drive", "02-nodes-and-topics", "03-services-and-parameters", "04-launch-files")
    for name in names:
        assert any(step.graph is not None for step in find_lesson(name).steps), name


def test_the_graph_of_every_step_fits_into_80_columns() -> None:
    for step in graph_steps():
        assert step.graph is not None
        playback = GraphPlayback(step.graph)
        assert playback.height == step.graph.least_rows, step.title
        playback.advance_to(step.graph.seconds)
        assert not any(len(line) > COLUMNS - 1 for line in playback.describe()), step.title


@pytest.mark.sampled(2)
@pytest.mark.parametrize(
    ("lesson", "controller"), [("01-drive", "teleop"), ("03-services-and-parameters", "bumper.py")]
)
def test_the_lines_are_those_of_the_running_nodes(lesson: str, controller: str) -> None:
    folder = find_lesson(lesson).folder
    with Session(find_scenario("simple"), seed=1, always_scan=True) as session:
        session.drive_with(find_controller(controller, folder))
        session.wait_until_driven()
        items = {item.name: item for item in build_graph_data(snapshot(session.graph)).items}
    for step in find_lesson(lesson).steps:
        for channel in step.graph.channels if step.graph is not None else ():
            item = items[channel.name]
            assert channel.sender in item.senders, channel
            assert set(channel.receivers) <= set(item.receivers), channel
            assert channel.is_service == item.is_service
