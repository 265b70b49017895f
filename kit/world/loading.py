"""Flatland's world and model files, read into records with every mistake of all their files at once."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from pathlib import Path

from kit.geometry import Pose
from kit.plain_text import quoted
from kit.world.documents import AllowedRoot, UnusableFile, WorldDocuments
from kit.world.layer_reader import LayerReader
from kit.world.model_loading import ModelPlacement, read_model
from kit.world.overlaps import note_overlaps
from kit.world.plugin_reader import (
    PluginReader,
    WorldPluginReader,
    WorldScope,
    read_plugins,
)
from kit.world.problems import Problem, ProblemCollector, WorldError
from kit.world.records import (
    Model,
    SourceLocation,
    World,
)
from kit.world.yaml_section import Section


def load_world(
    path: Path,
    *,
    plugin_readers: Mapping[str, PluginReader] | None = None,
    world_plugin_readers: Mapping[str, WorldPluginReader] | None = None,
    root: Path | None = None,
    environment: Mapping[str, str] | None = None,
) -> World:
    """The world that a file describes, with its layers and models.

    ``plugin_readers``, ``world_plugin_readers``: readers of the parameters of each type of plugin; without them types are
    not checked and ``PluginSpec.params`` is a plain mapping. ``root``: the folder that the world may not leave,
    by default its own. ``environment``: the variables that ``env()`` in a file may read, by default none, so
    that an untrusted world learns nothing about the machine. Raises WorldError with all that is wrong.
    """
    documents, file = _open_documents(path, root, environment)
    with documents.open(file) as section:
        return read_world(section, file, documents, plugin_readers, world_plugin_readers)


def load_model(
    path: Path,
    *,
    name: str,
    namespace: str = "",
    pose: Pose = Pose(),
    layer_bits: Mapping[str, int],
    plugin_readers: Mapping[str, PluginReader] | None = None,
    root: Path | None = None,
    environment: Mapping[str, str] | None = None,
) -> Model:
    """The model that a file describes, to be put into a running world whose layers are ``layer_bits``.

    The other arguments, and the errors, are those of ``load_world``.
    """
    documents, file = _open_documents(path, root, environment)
    entry = ModelPlacement(name, namespace, pose, file, SourceLocation(file))
    with documents.open(file) as section:
        return read_model(section, entry, layer_bits, plugin_readers)


def _open_documents(
    path: Path, root: Path | None, environment: Mapping[str, str] | None
) -> tuple[WorldDocuments, Path]:
    try:
        allowed_root = AllowedRoot.containing(path) if root is None else AllowedRoot.of_folder(root)
        file = allowed_root.path_inside(path)
    except UnusableFile as error:
        raise WorldError([Problem(SourceLocation(path), f"cannot read it: {error}")]) from error
    return WorldDocuments(allowed_root, environment or {}, ProblemCollector()), file


def read_world(
    section: Section,
    file: Path,
    documents: WorldDocuments,
    plugin_readers: Mapping[str, PluginReader] | None,
    world_plugin_readers: Mapping[str, WorldPluginReader] | None,
) -> World:
    """The world that a world file's mapping describes. What is wrong is noted.

    ============================== ====================================================================
    properties                     how exactly contacts are solved, at every step
    properties.velocity_iterations passes over all contacts for their velocities
    properties.position_iterations Flatland's; read and checked, and of no effect here
    layers                         what is drawn on the floor, in order: each name is one of at most 16
    layers[].name                  its name, or several, which its walls then have all
    layers[].map                   file of its walls, relative to this file; without it there are none
    layers[].color                 its colour
    layers[].properties            what others say of it; the kit looks at none of them
    models                         what stands on the floor
    models[].name                  its name, which no other has
    models[].model                 its model file, relative to this file
    models[].pose                  where it stands first [m, m, rad]
    models[].namespace             goes before its topics and frames
    plugins                        devices of the world itself
    plugins[].name                 its name, which no other has
    plugins[].type                 its type; the other keys are those of the type
    plugins[].enabled              false: the entry is not read
    ============================== ====================================================================
    """
    solver = section.section("properties")
    velocity_iterations = solver.integer("velocity_iterations", 10, minimum=1)
    position_iterations = solver.integer("position_iterations", 10, minimum=1)
    solver.finish()
    reader = LayerReader(documents)
    layers = reader.read(section.sections("layers"))
    entries = _read_model_entries(section.sections("models", ()), documents)
    models = [_read_model(entry, documents, reader.layer_bits, plugin_readers) for entry in entries]
    note_overlaps(section, layers, [model for model in models if model is not None])
    scope = WorldScope(layers, tuple(model for model in models if model is not None), reader.layer_bits)
    plugins = read_plugins(section.sections("plugins", ()), scope, world_plugin_readers)
    return World(
        file=file,
        layers=layers,
        models=scope.models,
        plugins=plugins,
        velocity_iterations=velocity_iterations,
        position_iterations=position_iterations,
        layer_bits=reader.layer_bits,
    )


def _read_model_entries(sections: Iterable[Section], documents: WorldDocuments) -> Iterator[ModelPlacement]:
    """Yields the placement and the file of each model of the world."""
    names: set[str] = set()
    for section in sections:
        name = section.name("name")
        if name and name in names:
            section.error(f"a model named {quoted(name)} already exists", "name")
        names.add(name)
        file = documents.referenced_file(section, "model")
        pose = section.pose("pose", Pose())
        namespace = section.text("namespace", "")
        section.finish()
        if file is not None:
            yield ModelPlacement(name, namespace, pose, file, section.location_of("model"))


def _read_model(
    entry: ModelPlacement,
    documents: WorldDocuments,
    layer_bits: Mapping[str, int],
    plugin_readers: Mapping[str, PluginReader] | None,
) -> Model | None:
    section = documents.section(entry.file, entry.location)
    return None if section is None else read_model(section, entry, layer_bits, plugin_readers)
