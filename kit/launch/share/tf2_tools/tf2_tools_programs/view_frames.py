"""Listens to transforms for five seconds and draws the tree of frames: as text, and as a file for Graphviz."""

import datetime
import shutil
import subprocess
from pathlib import Path

import rclpy
import yaml
from rclpy.node import Node
from tf2_ros import Buffer, TransformListener

SECONDS = 5.0


def tree(children: dict[str, list[str]], frame: str, depth: int = 0) -> list[str]:
    """A frame and those below it, a line each."""
    lines = ["  " * depth + frame]
    for child in sorted(children.get(frame, [])):
        lines += tree(children, child, depth + 1)
    return lines


def graph(frames: dict[str, dict[str, object]]) -> str:
    """The frames in Graphviz's language, with what is known of each transform."""
    lines = ["digraph G {"]
    for child, about in frames.items():
        label = "\\n".join(f"{name}: {value}" for name, value in about.items() if name != "parent")
        lines.append(f'"{about["parent"]}" -> "{child}" [label=" {label}"];')
    return "\n".join([*lines, "}", ""])


def main() -> None:
    rclpy.init()
    node = Node("view_frames")
    buffer = Buffer()
    TransformListener(buffer, node)
    node.get_logger().info(f"Listening to tf data for {SECONDS} seconds...")
    node.create_timer(SECONDS, rclpy.shutdown)
    rclpy.spin(node)
    frames = yaml.safe_load(buffer.all_frames_as_yaml()) or {}
    if not frames:
        print("No transforms were heard.")
        raise SystemExit(1)
    children: dict[str, list[str]] = {}
    for child, about in frames.items():
        children.setdefault(about["parent"], []).append(child)
    for root in sorted(children.keys() - frames.keys()):
        print("\n".join(tree(children, root)))
    name = f"frames_{datetime.datetime.now():%Y-%m-%d_%H.%M.%S}"
    Path(f"{name}.gv").write_text(graph(frames), encoding="utf-8")
    print(f"Generating graph in {name}.gv file...")
    if shutil.which("dot"):
        subprocess.run(["dot", "-Tpdf", "-o", f"{name}.pdf", f"{name}.gv"], check=True)
        print(f"Generating graph in {name}.pdf file...")
