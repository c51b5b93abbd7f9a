"""Replacements of the calls of ipctk that find candidates and step sizes."""

import functools

import ipctk

from ..replacements import Replacements
from .broad_phase import BroadPhase
from .steps import Steps

_DEFAULT = ipctk.TightInclusionCCD()
_installed = Replacements()


def install(device=None, *, replace_named=False):
    """Make ipctk find candidates and step sizes by nearmiss, until `uninstall` or the end of a `with` block.

    A call that names a broad phase or a narrow phase keeps these, except BroadPhase, TightInclusionCCD and AdditiveCCD. Functions
    that a program took before, by `from ipctk import`, stay as they are.

    - `device`: a nearmiss.Device; default: a GPU if there is one, else the CPU.
    - `replace_named`: also replace what a call names.
    """
    uninstall()
    calls = _Calls(device, replace_named)
    for owner in (ipctk.Candidates, ipctk.NormalCollisions, ipctk.SmoothCollisions):
        _replace(owner, "build", calls.with_broad_phase)
    _replace(ipctk, "has_intersections", calls.with_broad_phase)
    for name, answer in [("compute_collision_free_stepsize", _size), ("is_step_collision_free", _is_free)]:
        of_candidates = getattr(ipctk.Candidates, name)
        _replace(ipctk, name, functools.partial(calls.step_of_mesh, of_candidates, answer))
        _replace(ipctk.Candidates, name, functools.partial(calls.step_of_candidates, answer))
    return _installed


def uninstall():
    """Give ipctk its own calls back. Without an installation it does nothing."""
    _installed.undo()


class _Nothing(ipctk.BroadPhase):
    """A broad phase that finds no features: candidates of the mesh's planes alone are left."""

    def name(self):
        """Return "nothing"."""
        return "nothing"

    def _none(self):
        return []

    detect_vertex_vertex_candidates = detect_edge_vertex_candidates = detect_edge_edge_candidates = _none
    detect_face_vertex_candidates = detect_edge_face_candidates = detect_face_face_candidates = _none


def _replace(owner, name, make):
    own = getattr(owner, name)
    _installed.put(owner, name, functools.wraps(own)(make(own)))


def _size(toi, narrow_phase):
    """The size of a step until a first contact, scaled as the narrow phase scales its own."""
    return 1.0 if toi is None else getattr(narrow_phase, "conservative_rescaling", _DEFAULT.conservative_rescaling) * toi


def _is_free(toi, _):
    return toi is None


class _Calls:
    """Calls in place of ipctk's own."""

    def __init__(self, device, replace_named):
        self._broad_phase, self._replace_named = BroadPhase(device), replace_named
        self._steps = Steps(self._broad_phase.detectors)
        self._build_candidates = ipctk.Candidates.build

    def with_broad_phase(self, own):
        """The call with our broad phase. An overload that takes Candidates has none."""

        def call(*args, **named):
            is_named = any(isinstance(value, ipctk.BroadPhase) for value in (*args, *named.values()))
            has_candidates = any(isinstance(value, ipctk.Candidates) for value in (*args[1:], *named.values()))
            if has_candidates or (is_named and not self._replace_named):
                return own(*args, **named)
            args = [value for value in args if not (value is None or isinstance(value, ipctk.BroadPhase))]
            return own(*args, **{**named, "broad_phase": self._broad_phase})

        return call

    def step_of_mesh(self, of_candidates, answer, own):
        """The call about a step of a mesh; ipctk answers the part of the mesh's planes."""

        def call(mesh, vertices_t0, vertices_t1, min_distance=0.0, broad_phase=None, narrow_phase_ccd=_DEFAULT):
            step = mesh, vertices_t0, vertices_t1, min_distance
            if not self._takes(broad_phase, narrow_phase_ccd):
                return own(*step, broad_phase, narrow_phase_ccd)
            ours = answer(self._steps.first_contact(*step), narrow_phase_ccd)
            if not mesh.planes:
                return ours
            of_planes = ipctk.Candidates()
            self._build_candidates(of_planes, *step[:3], 0.5 * min_distance, _Nothing())
            return min(ours, of_candidates(of_planes, *step, narrow_phase_ccd))

        return call

    def step_of_candidates(self, answer, own):
        """The call about a step of candidates; ipctk answers those of planes."""

        def call(candidates, mesh, vertices_t0, vertices_t1, min_distance=0.0, narrow_phase_ccd=_DEFAULT):
            step = mesh, vertices_t0, vertices_t1, min_distance
            if not self._takes(None, narrow_phase_ccd):
                return own(candidates, *step, narrow_phase_ccd)
            ours = answer(self._steps.first_contact(*step, candidates), narrow_phase_ccd)
            of_planes = ipctk.Candidates()
            of_planes.pv_candidates = candidates.pv_candidates
            return min(ours, own(of_planes, *step, narrow_phase_ccd))

        return call

    def _takes(self, broad_phase, narrow_phase):
        """Whether a call with these phases is ours."""
        has_known = broad_phase is None or isinstance(broad_phase, BroadPhase)
        return self._replace_named or (has_known and type(narrow_phase) in (ipctk.TightInclusionCCD, ipctk.AdditiveCCD))
