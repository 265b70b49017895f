"""Flatland's world and model files, read into records with every mistake of all their files at once."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from pathlib import Path

from kit.geometry import Pose
from kit.world.documents import Documents
from kit.world.files import Enclosure, Unusable
from kit.world.layer_reader import LayerReader
from kit.world.model_reader import ModelEntry, read_model
from kit.world.plugin_reader import DeviceReader, WorldDeviceReader, WorldScope, read_plugins
from kit.world.problems import Problem, Problems, WorldError, quoted
from kit.world.records import Model, Place, World
from kit.world.yaml_section import Section


def load_world(
    path: Path,
    *,
    devices: Mapping[str, DeviceReader] | None = None,
    world_devices: Mapping[str, WorldDeviceReader] | None = None,
    root: Path | None = None,
    environment: Mapping[str, str] | None = None,
) -> World:
    """The world that a file describes, with its layers and models.

    ``devices``, ``world_devices``: who reads the parameters of each type of plugin; without them types are
    not checked and ``PluginSpec.params`` is a plain mapping. ``root``: the folder that the world may not leave,
    by default its own. ``environment``: the variables that ``env()`` in a file may read, by default none, so
    that a stranger's world learns nothing about the machine. Raises WorldError with all that is wrong.
    """
    documents, file = _open(path, root, environment)
    section = documents.section(file, Place(file))
    world = World(file) if section is None else _world(section, file, documents, devices, world_devices)
    documents.problems.raise_if_any()
    return world


def load_model(
    path: Path,
    *,
    name: str,
    namespace: str = "",
    pose: Pose = Pose(),
    layer_bits: Mapping[str, int],
    devices: Mapping[str, DeviceReader] | None = None,
    root: Path | None = None,
    environment: Mapping[str, str] | None = None,
) -> Model:
    """The model that a file describes, to be put into a running world whose layers are ``layer_bits``.

    The other arguments, and the errors, are those of ``load_world``.
    """
    documents, file = _open(path, root, environment)
    entry = ModelEntry(name, namespace, pose, file, Place(file))
    model = _model(entry, documents, layer_bits, devices)
    documents.problems.raise_if_any()
    assert model is not None  # None is noted as a problem
    return model


def _open(path: Path, root: Path | None, environment: Mapping[str, str] | None) -> tuple[Documents, Path]:
    try:
        enclosure = Enclosure.around(path) if root is None else Enclosure.of(root)
        file = enclosure.admit(path)
    except Unusable as error:
        raise WorldError([Problem(Place(path), f"cannot read it: {error}")]) from error
    return Documents(enclosure, environment or {}, Problems()), file


def _world(
    section: Section,
    file: Path,
    documents: Documents,
    devices: Mapping[str, DeviceReader] | None,
    world_devices: Mapping[str, WorldDeviceReader] | None,
) -> World:
    solver = section.section("properties")
    velocity_iterations = solver.integer("velocity_iterations", 10, minimum=1)
    position_iterations = solver.integer("position_iterations", 10, minimum=1)
    solver.finish()
    reader = LayerReader(documents)
    layers = reader.read(section.sections("layers"))
    entries = _model_entries(section.sections("models", ()), documents)
    models = [_model(entry, documents, reader.bits, devices) for entry in entries]
    scope = WorldScope(layers, tuple(model for model in models if model is not None), reader.bits)
    plugins = read_plugins(section.sections("plugins", ()), scope, world_devices)
    section.finish()
    return World(
        file=file,
        layers=layers,
        models=scope.models,
        plugins=plugins,
        velocity_iterations=velocity_iterations,
        position_iterations=position_iterations,
        layer_bits=reader.bits,
    )


def _model_entries(sections: Iterable[Section], documents: Documents) -> Iterator[ModelEntry]:
    """Where each model of the world stands, and the file that describes it."""
    names: set[str] = set()
    for section in sections:
        name = section.name("name")
        if name and name in names:
            section.error(f"a model named {quoted(name)} already exists", "name")
        names.add(name)
        file = documents.named(section, "model")
        pose = section.pose("pose", Pose())
        namespace = section.text("namespace", "")
        section.finish()
        if file is not None:
            yield ModelEntry(name, namespace, pose, file, section.place_of("model"))


def _model(
    entry: ModelEntry,
    documents: Documents,
    layer_bits: Mapping[str, int],
    devices: Mapping[str, DeviceReader] | None,
) -> Model | None:
    section = documents.section(entry.file, entry.place)
    return None if section is None else read_model(section, entry, layer_bits, devices)
