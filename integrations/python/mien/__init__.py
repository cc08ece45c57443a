# SPDX-License-Identifier: MIT
"""Facial rigs in DNA files: opened, evaluated and written. A binding of the C library Mien.

    import mien

    with mien.Dna.open("head.dna") as dna:
        rig = mien.Rig(dna)                      # shared, immutable
    face = rig.instance()                        # one character
    face["CTRL_expressions.jawOpen"] = 1.0
    face.evaluate(lod=0)
    face.joints                                  # float32 (joints, 9), no copy

`Dna` -> `Rig` -> `Instance` or `Batch`. README.md has more; errors are in `mien.errors`.
"""
from ._api import (Arithmetic, AuthorFlags, BakedCheck, BakedInfo, BlendMode, BoneKind, ClipChannel,
                   ClipInfo, ClipPlayerInfo, Compose, Conformed, CoordinateSystem, DeformerInfo, Direction,
                   DnaField, DnaInfo, DnaLayer, FaceWinding, FieldType, FileAccess, Finding,
                   FitConstraintKind, FitStatus,
                   Generate, Generator, Guard, InstanceStatistics, Interpolation, Isa, Kind, Layer,
                   LayerGroup, LayerSource, Looping, Match, MeshAxis, MixerInfo, MixInfo, MlMasks, NameMatch, Normals,
                   Point, Preset, PrunedJoints, PrunedTargets, Retrigger, Reuse, RigInfo, RigStatistics, RotationOutput, RotationRule,
                   RotationSequence, RotationUnit, Severity, SolverStackInfo, Stage, Status,
                   Storage, Symmetry, Transition, TranslationUnit, UnknownLayers, Weights)
from ._api import VERSION as _VERSION
from ._library import path as library_path, version
from .author import AuthorBone, AuthoredRig, author_rig
from .baked import Baked
from .batch import Batch
from .clip import (Clip, ClipBinding, ClipEvent, ClipPlayer, TICKS_PER_SECOND,
                   arkit_matrix)
from .deformer import Deformer, DeformerInstance, Mesh, deform_batch, write_vertices_batch
from .derivatives import Derivatives, Jacobian
from .dna import Dna, coordinate_system, coordinate_system_names, validate
from .document import ControlError, Document, DocumentLayer
from .errors import (ArgumentError, AuthorError, BusyError, ClipError, ClosedError, DnaError, Error,
                     FileError, MixError, OutOfMemoryError, OutOfRangeError, UnknownNameError)
from .fit import Fit, FitCamera, FitConstraint, FitResult, FitSurface, reduce_keys, solve
from .instance import Instance
from .mix import Gaze, Mix
from .mix_parts import (NO_CONTROL, Antagonists, CustomGuard, Landmark, MixLayer, Reaction, Stroke,
                        glare, ticks)
from .mix_view import GuardInfo
from .mixer import GuardState, MixEvent, Mixer, step_mixers
from .rig import Rig
from .rig_view import control_name, isa_available, isa_name
from .solver_stack import (NO_JOINT, AimSolver, CopySolver, CustomSolver, SolverPose, SolverStack,
                    SolverState, SpaceSolver, SpringSolver, TwistSolver, step_states)

__version__ = _VERSION

__all__ = [
    "__version__", "AimSolver", "Antagonists", "ArgumentError", "Arithmetic", "arkit_matrix",
    "AuthorBone", "AuthoredRig", "AuthorError", "AuthorFlags", "author_rig", "Baked",
    "BakedCheck", "BakedInfo", "Batch", "BlendMode", "BoneKind", "BusyError", "Clip", "ClipBinding",
    "ClipChannel", "ClipError", "ClipEvent", "ClipInfo", "ClipPlayer", "ClipPlayerInfo",
    "ClosedError", "Compose", "Conformed", "control_name", "ControlError", "coordinate_system", "coordinate_system_names",
    "CoordinateSystem", "CopySolver", "CustomGuard", "CustomSolver", "deform_batch", "Deformer",
    "DeformerInfo", "DeformerInstance", "Derivatives", "Direction", "Dna", "DnaError", "DnaField", "DnaInfo",
    "DnaLayer", "Document", "DocumentLayer", "Error", "FaceWinding", "FieldType", "FileAccess", "FileError", "Finding", "Fit", "FitCamera",
    "FitConstraint", "FitConstraintKind",
    "FitResult", "FitStatus", "FitSurface",
    "Gaze", "Generate", "Generator", "glare", "Guard", "GuardInfo", "GuardState", "Instance",
    "InstanceStatistics", "Interpolation", "Isa", "isa_available", "isa_name", "Jacobian", "Kind",
    "Landmark", "Layer", "LayerGroup", "LayerSource", "library_path", "Looping", "Match", "Mesh", "MeshAxis", "Mix",
    "Mixer", "MixerInfo", "MixError", "MixEvent", "MixInfo", "MixLayer", "MlMasks", "NO_CONTROL",
    "NameMatch", "NO_JOINT", "Normals", "OutOfMemoryError", "OutOfRangeError", "Point", "Preset", "PrunedJoints",
    "PrunedTargets", "Reaction", "reduce_keys",
    "Retrigger", "Reuse", "Rig", "RigInfo", "RigStatistics", "RotationOutput", "RotationRule",
    "RotationSequence", "RotationUnit", "Severity", "solve", "SolverPose", "SolverStack",
    "SolverStackInfo", "SolverState", "SpaceSolver", "SpringSolver", "Stage", "Status",
    "step_mixers", "step_states", "Storage", "Stroke", "Symmetry", "ticks", "TICKS_PER_SECOND",
    "Transition", "TranslationUnit", "TwistSolver", "UnknownLayers", "UnknownNameError",
    "validate", "version", "Weights", "write_vertices_batch",
]
