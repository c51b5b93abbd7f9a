from os import PathLike
from typing import Any, Generic, Iterable, Literal, Mapping, Sequence, Tuple, TypeVar, Union, overload

import numpy as np
from numpy.typing import NDArray

__version__: str

Array = Any
"""What numpy can read, or an array of a GPU with DLPack or __cuda_array_interface__."""
Motion = Union[Array, Tuple[Array, Array], "Pose", Tuple["Pose", "Pose"], "PoseStep"]
"""Positions or a pose, or a tuple of two for the start and the end of a step; a step of a rigid body."""
Key = Union[int, str]
"""Number or name of a body."""
Motions = Union[Mapping[int, Motion], Mapping[str, Motion], Mapping[Key, Motion]]
"""Motions of bodies, by number or by name."""

_A = TypeVar("_A", bound="Answer", covariant=True)
_Q = TypeVar("_Q", bound="Query[Any]")

def is_on_gpu(object: Any) -> bool:
    """Return whether an array is in the memory of an NVIDIA GPU."""

@overload
def read_mesh(
    path: Union[str, PathLike[str]], *, strict: bool = False, elements: Literal[False] = False
) -> tuple[NDArray[Any], NDArray[np.uint32]]:
    """Read a PLY, OBJ, STL, OFF or glTF file, also with .gz appended.

    - `path`: the file.
    - `strict`: raise InputError for each part of the file that would be skipped or cut otherwise.
    - `elements`: also return edges and points of no face.

    Returns (vertices, faces): (n, 3) float32 or float64 as in the file, and (m, 3) uint32. Polygons
    are cut into triangles. Lines and points of the file come behind them as faces [a, b, b] and
    [p, p, p]. With `elements`, returns (vertices, faces, edges, points) for Body: edges are (k, 2)
    uint32 and points (l,) uint32. A MeshWarning counts parts that are skipped, left out (faces of
    one or two corners) or cut as a fan (faces that cross themselves).

    Raises InputError for a file that is no mesh, with the line or element.
    """
@overload
def read_mesh(
    path: Union[str, PathLike[str]], *, strict: bool = False, elements: Literal[True]
) -> tuple[NDArray[Any], NDArray[np.uint32], NDArray[np.uint32], NDArray[np.uint32]]:
    """Read a PLY, OBJ, STL, OFF or glTF file, also with .gz appended.

    - `path`: the file.
    - `strict`: raise InputError for each part of the file that would be skipped or cut otherwise.
    - `elements`: also return edges and points of no face.

    Returns (vertices, faces): (n, 3) float32 or float64 as in the file, and (m, 3) uint32. Polygons
    are cut into triangles. Lines and points of the file come behind them as faces [a, b, b] and
    [p, p, p]. With `elements`, returns (vertices, faces, edges, points) for Body: edges are (k, 2)
    uint32 and points (l,) uint32. A MeshWarning counts parts that are skipped, left out (faces of
    one or two corners) or cut as a fan (faces that cross themselves).

    Raises InputError for a file that is no mesh, with the line or element.
    """

def configure(
    query: _Q,
    *,
    solver: Literal[
        "exact", "moller", "certified", "certified-f32", "certified-f64", "cubic-f64", "cubic-f32", "bounded"
    ]
    | None = None,
    broad_phase: Literal["tree", "tiles"] | None = None,
    bounding_volume: Literal["aabb", "obb", "linear"] | None = None,
    rebuild: Literal["auto", "manual"] | None = None,
) -> _Q:
    """Return the same query with other choices of the laboratory.

    No choice except `solver` changes an answer. None keeps the choice of `query`.

    - `query`: any query.
    - `solver`: test of a pair. Discrete: "exact", or "moller", which can miss and invent contacts.
      Continuous and Earliest: "certified", "certified-f32", "certified-f64", or "cubic-f64" and
      "cubic-f32", which can miss contacts and take neither a tolerance nor a minimum separation.
    - `broad_phase`: "tiles" or "tree".
    - `bounding_volume`: volume of a triangle, "aabb" or "linear"; "obb" of trees.
    - `rebuild`: "auto" rebuilds tiles and trees when their boxes have become loose; "manual" does
      so by Detector.rebuild alone.

    Raises InvalidArgumentError for choices that do not exist or exclude each other.
    """

class Device:
    """Machine that runs queries: the CPU, or an NVIDIA GPU.

    - `backend`: "auto" (a GPU if there is one, else the CPU), "cpu" or "cuda".
    - `threads`: threads of the CPU, 1 to 1024, at most one a processor. Default: all.
    - `gpu`: number of a GPU. It gets a stream of its own.
    - `stream`: your stream, of any GPU: a stream of torch or cupy, an object with __cuda_stream__, or a
      handle (0: the default stream of the GPU that this thread is bound to). All work goes there. It must
      outlive the device; its context also every answer and every array of one.
    - `memory_limit`: most bytes of device memory to take, at least 1. Default: all there are.

    Raises DeviceError if there is no such machine. Detectors of any threads may share a device: they
    take turns. For work side by side open two.
    """

    def __new__(
        cls,
        backend: Literal["auto", "cpu", "cuda"] = "auto",
        *,
        threads: int | None = None,
        gpu: int | None = None,
        stream: Any = None,
        memory_limit: int | None = None,
    ) -> Device: ...

    @property
    def name(self) -> str:
        """Name of the machine."""

    @property
    def backend(self) -> Literal["cpu", "cuda"]:
        """Kind of the machine: "cpu" or "cuda"."""

    @property
    def gpu(self) -> int | None:
        """Number of the GPU; None for a CPU."""

    @property
    def stream(self) -> int | None:
        """Handle of the stream that all work goes to, 0 for the default one; None for a CPU."""

    @property
    def bytes(self) -> tuple[int, int]:
        """Bytes of device memory held now, and the most held at once."""

    @property
    def allocations(self) -> int:
        """Number of times that device memory was taken."""

    @property
    def uploaded(self) -> int:
        """Bytes copied from the host to the device."""

class Pose:
    """Pose of a rigid body: rotation, then translation.

    - `rotation`: unit quaternion (x, y, z, w), default (0, 0, 0, 1). Its length may differ from 1 by
      1.19e-4; it is normalised.
    - `translation`: (x, y, z) in the unit of the vertices, default (0, 0, 0).

    A vertex v is placed at R v + t in float64, also of a mesh in float32. Both may be arrays of a
    GPU, of 4 and 3 float32 or float64 numbers. Raises InputError for numbers that are no pose, and
    InvalidArgumentError for other shapes; poses on a GPU are checked by the next query.

    A (4, 4) array is taken wherever a Pose is: see `from_matrix`.
    """

    def __new__(cls, rotation: Array = None, translation: Array = None) -> Pose: ...

    @staticmethod
    def from_matrix(matrix: Array) -> Pose:
        """Return the pose of a matrix, (4, 4) numbers, or (3, 4) without the last row.

        The translation is in the last column. The last row is 0, 0, 0, 1. Columns of the rotation may
        be off unit length, and scalar products of two of them off 0, by up to 1.19e-4. The nearest
        rotation is taken. Raises InputError for a number that is not finite, another last row, scale,
        shear and a mirror image. The message names the number.
        """

    @property
    def matrix(self) -> NDArray[np.float64]:
        """(4, 4) float64: the matrix of the pose, a copy.

        Raises InvalidArgumentError for a pose on a GPU.
        """

    @property
    def rotation(self) -> Array:
        """Rotation x, y, z, w: a tuple of numbers, or the array on a GPU."""

    @property
    def translation(self) -> Array:
        """Translation: a tuple of numbers, or the array on a GPU."""

class PoseStep:
    """Step of a rigid body from one pose to another, and the path between them.

    The body turns at a constant rate about a pivot, which moves in a straight line. It turns by the
    shorter arc; `turning` makes other turns. At exactly 180 degrees the axis is that with a positive
    first coordinate; if this is 0, a positive second or third one.

    - `start`, `end`: a Pose or a (4, 4) array each. Both may be on a GPU.
    - `pivot`: the point about which it turns, in the frame of the mesh: a centre of mass, a hinge.
    - `straight`: vertices go in straight lines instead; between the poses the body is not rigid.

    A tuple of two poses is the step about the origin of the mesh. Poses on a GPU always turn so.
    Raises InputError for numbers that are no step, InvalidArgumentError for a pivot of a straight one.
    """

    def __new__(
        cls,
        start: Union[Pose, Array],
        end: Union[Pose, Array],
        *,
        pivot: Array = (0, 0, 0),
        straight: bool = False,
    ) -> PoseStep: ...

    @staticmethod
    def turning(
        start: Union[Pose, Array],
        turn: Array,
        travel: Array = (0, 0, 0),
        *,
        pivot: Array = (0, 0, 0),
    ) -> PoseStep:
        """Return the step that turns by a rotation vector while its pivot moves by `travel`.

        Turns of more than 180 degrees need it: two poses cannot give them.

        - `start`: a Pose or a (4, 4) array.
        - `turn`: 3 numbers in the axes of the scene, in radians: angular velocity times the length of
          the step. At most a whole turn, 2 pi.
        - `travel`: how far the pivot moves.
        - `pivot`: the point about which it turns, in the frame of the mesh.
        """

    @property
    def start(self) -> Pose:
        """Pose at the start."""

    @property
    def end(self) -> Pose:
        """Pose at the end."""

    @property
    def pivot(self) -> tuple[float, float, float]:
        """Point about which it turns, in the frame of the mesh; zeros of a straight step."""

    @property
    def turn(self) -> tuple[float, float, float] | None:
        """Rotation vector that was given to `turning`; None of other steps."""

    @property
    def straight(self) -> bool:
        """Whether vertices go in straight lines."""

class Body:
    """Mesh that takes part in a scene: its way to move, and the bodies that it may meet.

    - `vertices`: (n, 3) numbers, copied. float32 and float64 are kept, others become float64.
    - `faces`: (m, 3) integers from 0, the vertices of each triangle, copied. It may be empty if there
      are edges or points.
    - `kind`: "deformable" (each vertex moves by itself), "rigid" (moves by a Pose) or "fixed" (never
      moves; cheapest).
    - `self_collision`: whether the body is tested against itself. Default: deformable bodies are,
      rigid bodies are not. Fixed bodies never are: True raises InvalidArgumentError.
    - `environment`: bodies of different environments never meet; None is in all of them.
    - `group`, `mask`: 32 bits each. Two bodies meet if each is in a group of the other's mask. ~1
      is all bits except the lowest.
    - `name`: name of the body in messages; it may be used in place of its number.
    - `pose`: of a rigid body, where it begins: a Pose or a (4, 4) array. Default: where its mesh is.
    - `thickness`: radius around the surface that belongs to the body, a length of at least 0; or one
      for each vertex, in between linear. Near queries and queries in motion add those of both bodies
      to their distance; all others ignore them.
    - `edges`: (k, 2) integers. Edges of no face take part by themselves, as hair and threads do. Edges
      of answers have their numbers in this list; those of faces that it lacks come behind, by
      (larger vertex, smaller vertex).
    - `points`: vertices that take part by themselves, as particles do. Those of a face or an edge do
      anyway.

    Raises InvalidArgumentError for a thickness that is no length.
    Raises InputError for vertices that are not finite and for indices without a vertex.
    """

    def __new__(
        cls,
        vertices: Array,
        faces: Array,
        *,
        kind: Literal["deformable", "rigid", "fixed"] = "deformable",
        self_collision: bool | None = None,
        environment: int | None = 0,
        group: int = 0xFFFFFFFF,
        mask: int = 0xFFFFFFFF,
        name: str = "a mesh",
        pose: Union[Pose, Array, None] = None,
        thickness: Union[float, Array] = 0.0,
        edges: Array | None = None,
        points: Array | None = None,
    ) -> Body: ...

    @property
    def name(self) -> str:
        """Name of the body in messages."""

    @property
    def pose(self) -> Pose | None:
        """Pose at which a rigid body begins; None of other bodies."""

    @property
    def thickness(self) -> Union[float, NDArray[np.float64]]:
        """Thickness: a radius, or an array of one for each vertex."""

    @property
    def vertex_count(self) -> int:
        """Number of vertices."""

    @property
    def face_count(self) -> int:
        """Number of triangles."""

    @property
    def edges(self) -> NDArray[np.uint32]:
        """Edges, as given: (k, 2) integers."""

    @property
    def points(self) -> NDArray[np.uint32]:
        """Points, as given."""

class Scene:
    """Bodies, numbered from 0 in the order in which they are added.

    - `bodies`: the first bodies.

    A detector takes a copy. From then on, add, remove and replace bodies of the detector.
    """

    def __new__(cls, *bodies: Body) -> Scene: ...

    def add(self, body: Body) -> int:
        """Add a body, and return its number."""

    def remove(self, body: Key) -> None:
        """Remove a body, by number or name. The next body that is added may take its number."""

    def leave_out(self, pairs: Iterable[tuple[Key, Key]]) -> None:
        """Replace the list of pairs of bodies that are not tested against each other, by any query.

        - `pairs`: [(a, b), ...], numbers or names of bodies, as the links of a robot that share a joint.
          Order and repeats do not matter; [] leaves out none.

        A body that is removed takes its pairs with it.
        Raises InvalidArgumentError for a body that does not exist, and for a body with itself: then the
        list is as before.
        """

    @property
    def left_out(self) -> list[tuple[int, int]]:
        """Pairs of bodies that are left out: the smaller number first, ascending."""

    def exclude(
        self,
        body: Key,
        *,
        ring: int | None = None,
        within: float | None = None,
        rest: Array | None = None,
        faces: Array | None = None,
    ) -> None:
        """Replace the exclusions of a body: pairs of its features, and faces that take no part.

        A feature is a vertex, an edge or a face.

        - `ring`: from 1. Two features are left out if at most ring - 1 edges are between a vertex of one
          and a vertex of the other. Ring 1 has pairs with a common vertex. All queries leave
          these out, except Discrete(adjacent=True). Ring 2 also has pairs that an edge joins.
        - `within`: a length. Pairs of features that are nearer than this in the rest shape are left out.
        - `rest`: the rest shape, an (n, 3) array. Default: the place of the body, at t = 0.
        - `faces`: indices of faces that take no part, and with them vertices and edges of no other face.

        exclude(body) alone excludes nothing. All queries obey, except Distance, BodyPairs and
        BodyDistances: these raise InvalidArgumentError if there are exclusions. A removed body loses its
        exclusions.

        Raises InvalidArgumentError for a body or a face that does not exist, and for a ring of 0. Also for
        a length that is negative or not finite, and for a rest shape of another number of vertices.
        InputError for vertices that are not finite. Then nothing has changed.
        """

    def exclude_pairs(self, body: Key, other: Key, pairs: Array) -> None:
        """Replace the list of pairs of vertices of two bodies whose features are not tested together.

        - `body`, `other`: numbers or names of bodies; they may be the same.
        - `pairs`: (n, 2) integers: a vertex of body, and one of other. Order and repeats do not matter; []
          leaves out none. A pair of features is left out if the list has a vertex of each as a pair.

        A body that is removed takes its lists with it.

        Raises InvalidArgumentError for a body or a vertex that does not exist, and for a vertex with
        itself. Then the list is as before.
        """

    def excluded_pairs(self, body: Key, other: Key) -> NDArray[np.uint32]:
        """Pairs of vertices of two bodies that are left out, as an (n, 2) array, ascending."""

    def id(self, name: str) -> int:
        """Return the number of the one body with that name: scene[name] is the same.

        Raises InvalidArgumentError if no body has the name, or several have; it lists them.
        """

    def __getitem__(self, name: str) -> int: ...

    @property
    def bodies(self) -> list[int]:
        """Numbers of all bodies, ascending."""

    def __len__(self) -> int: ...

class Query(Generic[_A]):
    """Base class of all queries.

    These are Discrete, Continuous, Earliest, Near, Distance, BodyPairs and BodyDistances.
    A query is a value: it can be compared, hashed, copied and pickled. Each class of queries has an
    answer class of its own. Queries with other numbers use the same memory of a detector.
    """

class Discrete(Query["TrianglePairs"]):
    """Query for triangles that share a point at t = 0, by exact signs. Answer: TrianglePairs.

    - `adjacent`: also test triangles with a common vertex, for points beyond that vertex or edge.
    - `only_crossing`: leave out triangles that touch without crossing: a wall that stands on a floor.
      See PairKind.CROSSING.
    """

    def __new__(cls, *, adjacent: bool = False, only_crossing: bool = False) -> Discrete: ...

class Continuous(Query["Contacts"]):
    """Query for all contacts of a step, with certified times. Answer: Contacts.

    From t = 0 to t = 1 vertices move in straight lines, and rigid bodies turn: see PoseStep.
    Features with a common vertex are left out.

    - `tolerance`: accuracy of times, as a length, at least 0. Default: of two bodies the
      smaller 1e-4 of the mean edge. A smaller one takes longer. None loses a contact.
    - `min_separation`: minimum separation, a length of at least 0. Features that come this
      near count as contacts. Default 0: touching.
    - `max_iterations`: most iterations for a pair, at least 1. A pair that needs more is
      reported as undecided. Default 4096.
    - `assume_free`: skip the count of triangle pairs that cross at the start of the step.
    - `approaching`: features within `min_separation` at the start are in contact from when
      they come nearer than there, so they may rest, slide and part.
    """

    def __new__(
        cls,
        *,
        tolerance: float | None = None,
        min_separation: float = 0.0,
        max_iterations: int | None = None,
        assume_free: bool = False,
        approaching: bool = False,
    ) -> Continuous: ...

class Earliest(Query["FirstContact"]):
    """Query for the first contact of a step: how long a step is safe. Answer: FirstContact.

    From t = 0 to t = 1 vertices move in straight lines, and rigid bodies turn: see PoseStep. No
    contact is before the returned time.

    - `tolerance`: accuracy of times, as a length, at least 0. Default: of two bodies the
      smaller 1e-4 of the mean edge. A smaller one takes longer. None loses a contact.
    - `min_separation`: minimum separation, a length of at least 0. Features that come this
      near count as contacts. Default 0: touching.
    - `max_iterations`: most iterations for a pair, at least 1. A pair that needs more is
      reported as undecided. Default 4096.
    - `assume_free`: skip the count of triangle pairs that cross at the start of the step.
    - `approaching`: features within `min_separation` at the start are in contact from when
      they come nearer than there, so they may rest, slide and part.
    """

    def __new__(
        cls,
        *,
        tolerance: float | None = None,
        min_separation: float = 0.0,
        max_iterations: int | None = None,
        assume_free: bool = False,
        approaching: bool = False,
    ) -> Earliest: ...

class Near(Query["NearPairs"]):
    """Query for features within a distance at t = 0. Answer: NearPairs.

    - `distance`: a length above 0, in the unit of the vertices. No pair within it is missed. It may be
      0 if a body has a thickness.

    A pair is two features: see `Kind`. Features with a common vertex are left out.
    """

    def __new__(cls, distance: float) -> Near: ...

class Distance(Query["NearestTriangles"]):
    """Query for the distance of the nearest two bodies at t = 0. Answer: NearestTriangles.

    The distance is 0 if and only if two bodies share a point. A body has no distance from itself.
    """

    def __new__(cls) -> Distance: ...

class BodyPairs(Query["TouchingBodies"]):
    """Query for pairs of bodies that share a point at t = 0, by exact signs. Answer: TouchingBodies.

    - `first`: list the first pairs alone, at least 1. With 1 the work ends early. Default: all.

    Pairs within a body do not count, even if it has self-collision.
    """

    def __new__(cls, *, first: int | None = None) -> BodyPairs: ...

class BodyDistances(Query["NearestBodies"]):
    """Query for the least distance of each two bodies at t = 0. Answer: NearestBodies.

    - `within`: largest distance of a row, a length of at least 0, in the unit of the vertices.

    A distance is 0 if and only if the bodies share a point. A body has no distance from itself.
    """

    def __new__(cls, within: float) -> BodyDistances: ...

class Answer:
    """Base class of all answers.

    Rows are in canonical order, the same on every machine. Columns are read-only numpy arrays. Most
    are fields of the rows, in their memory: copy one before you write to it, or to have its numbers
    side by side.
    """

    @property
    def query(self) -> Query[Any]:
        """Query of this answer."""

    @property
    def caveats(self) -> list[str]:
        """Caveats, a sentence each: limits of this answer. Empty if there are none."""

    @property
    def candidates(self) -> int:
        """Number of pairs that the narrow phase tested."""

    @property
    def hash(self) -> str:
        """Hash of the answer, 16 hexadecimal digits. Equal answers have equal hashes on every machine."""

class TrianglePairs(Answer):
    """Answer of Discrete: triangles that share a point, a row a pair.

    Rows ascend by the first triangle and its body, then by the second.
    """

    def __len__(self) -> int: ...

    @property
    def bodies(self) -> NDArray[np.uint32]:
        """(k, 2) uint32: bodies of both triangles, the smaller number first."""

    @property
    def names(self) -> NDArray[np.object_]:
        """(k, 2) objects: names of both bodies."""

    @property
    def triangles(self) -> NDArray[np.uint32]:
        """(k, 2) uint32: both triangles, by their indices in their bodies."""

    @property
    def is_free(self) -> bool:
        """Whether no two triangles share a point; False with `only_crossing`, which does not show it."""

class Contacts(Answer):
    """Answer of Continuous: features that meet within the step, a row a pair.

    A row is two features: see `Kind`. Rows ascend by `kind`, then by feature a and its
    body, then by feature b. An edge that already passes through a face at the start has no row: see
    `starts_crossing`.
    """

    def __len__(self) -> int: ...

    @property
    def kind(self) -> NDArray[np.uint8]:
        """(k,) uint8: which features meet, see Kind."""

    @property
    def bodies(self) -> NDArray[np.uint32]:
        """(k, 2) uint32: body of feature a, body of feature b."""

    @property
    def names(self) -> NDArray[np.object_]:
        """(k, 2) objects: name of the body of feature a, and of that of feature b."""

    @property
    def feature_a(self) -> NDArray[np.uint32]:
        """(k,) uint32: the vertex, or the first edge, by its index in its body."""

    @property
    def feature_b(self) -> NDArray[np.uint32]:
        """(k,) uint32: the face, or the second edge, by its index in its body."""

    @property
    def toi(self) -> NDArray[np.float64]:
        """(k,) float64 in [0, 1]: lower bound of the time of impact. No contact is earlier."""

    @property
    def toi_upper(self) -> NDArray[np.float64]:
        """(k,) float64 in [toi, 1]: upper bound of the time of impact. Certified pairs have met by it."""

    @property
    def status(self) -> NDArray[np.uint8]:
        """(k,) uint8: certainty of the row, see Status."""

    @property
    def earliest_toi(self) -> float | None:
        """Smallest `toi`; None without a row."""

    @property
    def starts_crossing(self) -> int | None:
        """Number of triangle pairs that share a point at the start; None with `assume_free`.

        As many as Discrete lists there. Such a pair need not have a row.
        """

    @property
    def is_free(self) -> bool:
        """Whether the step is proven to be free: no row, and no triangles cross at the start."""

    @property
    def undecided(self) -> int:
        """Number of rows whose status is undecided."""

class FirstContact(Answer):
    """Answer of Earliest: the first contact of the step."""

    @property
    def toi(self) -> float | None:
        """Time of the first contact, in [0, 1]; None if nothing meets. No contact is earlier.

        Triangles that cross at the start need not have a time: see `is_free`.
        """

    @property
    def is_undecided(self) -> bool:
        """Whether the pair at `toi` is undecided: it comes within the tolerance, and may not meet."""

    @property
    def starts_crossing(self) -> int | None:
        """Number of triangle pairs that share a point at the start; None with `assume_free`."""

    @property
    def is_free(self) -> bool:
        """Whether the step is proven to be free: no contact, and no triangles cross at the start."""

class NearPairs(Answer):
    """Answer of Near: features within the distance, a row a pair.

    A row is two features: see `Kind`. Rows ascend by `kind`, then by feature a and its
    body, then by feature b.
    """

    def __len__(self) -> int: ...

    @property
    def kind(self) -> NDArray[np.uint8]:
        """(k,) uint8: which features are near, see Kind."""

    @property
    def bodies(self) -> NDArray[np.uint32]:
        """(k, 2) uint32: body of feature a, body of feature b."""

    @property
    def names(self) -> NDArray[np.object_]:
        """(k, 2) objects: name of the body of feature a, and of that of feature b."""

    @property
    def feature_a(self) -> NDArray[np.uint32]:
        """(k,) uint32: the vertex, or the first edge, by its index in its body."""

    @property
    def feature_b(self) -> NDArray[np.uint32]:
        """(k,) uint32: the face, or the second edge, by its index in its body."""

    @property
    def distances(self) -> NDArray[np.float64]:
        """(k,) float64: distances of the features, in the unit of the vertices.

        Roots of `squared_distances`: below 1.5e-154 they have fewer digits, below 1.6e-162 they are
        0.
        """

    @property
    def squared_distances(self) -> NDArray[np.float64]:
        """(k,) float64: squares of the distances."""

    @property
    def weights(self) -> NDArray[np.float64]:
        """(k, 4) float64: weights of the four vertices in the nearest points.

        Vertices are in the order of Geometry.vertices: the vertex and the face's corners, or both
        ends of edge a and of edge b. The weights of each feature sum to 1.
        """

    @property
    def closest(self) -> NDArray[np.uint8]:
        """(k,) uint8: the nearest parts of both features, see Closest."""

    @property
    def min_distance(self) -> float | None:
        """Smallest of the distances; None without a row."""

    @property
    def undecided(self) -> int:
        """Number of rows so near to the distance that rounding decides about them."""

class TouchingBodies(Answer):
    """Answer of BodyPairs: bodies that share a point, a row a pair.

    Rows ascend by the first body, then by the second.
    """

    def __len__(self) -> int: ...

    @property
    def bodies(self) -> NDArray[np.uint32]:
        """(k, 2) uint32: both bodies, the smaller number first."""

    @property
    def names(self) -> NDArray[np.object_]:
        """(k, 2) objects: names of both bodies."""

    @property
    def is_free(self) -> bool:
        """Whether no two bodies share a point."""

class NearestBodies(Answer):
    """Answer of BodyDistances: each two bodies within the distance, a row a pair.

    A row has their nearest triangles. Rows ascend by the first body, then by the second.
    """

    def __len__(self) -> int: ...

    @property
    def bodies(self) -> NDArray[np.uint32]:
        """(k, 2) uint32: both bodies, the smaller number first."""

    @property
    def names(self) -> NDArray[np.object_]:
        """(k, 2) objects: names of both bodies."""

    @property
    def triangles(self) -> NDArray[np.uint32]:
        """(k, 2) uint32: the nearest triangles, by their indices in their bodies."""

    @property
    def distances(self) -> NDArray[np.float64]:
        """(k,) float64: distances of the bodies: 0 if and only if they share a point."""

    @property
    def weights(self) -> NDArray[np.float64]:
        """(k, 2, 3) float64: weights of the three corners of each triangle in its nearest point."""

    @property
    def points(self) -> NDArray[np.float64]:
        """(k, 2, 3) float64: the nearest point of each triangle, in the unit of the vertices."""

    @property
    def min_distance(self) -> float | None:
        """Least of the distances; None without rows."""

    @property
    def is_free(self) -> bool:
        """Whether no two bodies share a point."""

class NearestTriangles(Answer):
    """Answer of Distance: the nearest two triangles of different bodies.

    All values are None if no two bodies may meet.
    """

    @property
    def min_distance(self) -> float | None:
        """Distance of the nearest two bodies: 0 if and only if they share a point."""

    @property
    def bodies(self) -> NDArray[np.uint32] | None:
        """(2,) uint32: both bodies, the smaller number first."""

    @property
    def names(self) -> NDArray[np.object_] | None:
        """(2,) objects: names of both bodies."""

    @property
    def triangles(self) -> NDArray[np.uint32] | None:
        """(2,) uint32: both triangles, by their indices in their bodies."""

    @property
    def weights(self) -> NDArray[np.float64] | None:
        """(2, 3) float64: weights of the three corners of each triangle in its nearest point."""

    @property
    def points(self) -> NDArray[np.float64] | None:
        """(2, 3) float64: the nearest point of each triangle, in the unit of the vertices."""

    @property
    def is_free(self) -> bool:
        """Whether the distance is above 0, or no two bodies may meet."""

class Geometry:
    """Places of contacts or near pairs: a row a pair, in the order of the answer.

    A row has four vertices: the vertex and the face's three corners, or both ends of edge a and of
    edge b. The end with the larger index comes first. Places are those at the time of contact, or at
    t = 0 for near pairs. Columns are read-only numpy arrays.
    """

    def __len__(self) -> int: ...

    @property
    def owner(self) -> NDArray[np.uint32]:
        """(k, 4) uint32: body of each of the four vertices."""

    @property
    def vertices(self) -> NDArray[np.uint32]:
        """(k, 4) uint32: the four vertices, by their indices in their bodies."""

    @property
    def weights(self) -> NDArray[np.float64]:
        """(k, 4) float64: weight of each vertex in the nearest point of its feature.

        None is negative. The weights of each feature sum to 1.
        """

    @property
    def signed_weights(self) -> NDArray[np.float64]:
        """(k, 4) float64: weights, positive for feature a and negative for feature b.

        The sum of `signed_weights` times positions leads from the point on b to the point on a.
        """

    @property
    def points(self) -> NDArray[np.float64]:
        """(k, 2, 3) float64: the nearest point of each feature, in the unit of the vertices."""

    @property
    def distances(self) -> NDArray[np.float64]:
        """(k,) float64: distances of these points."""

    @property
    def normals(self) -> NDArray[np.float64]:
        """(k, 3) float64: unit vectors from feature b to feature a; zeros if no direction is defined."""

class PairGeometry:
    """Kinds and segments of triangle pairs: a row a pair, in the order of the answer.

    Columns are read-only numpy arrays.
    """

    def __len__(self) -> int: ...

    @property
    def kind(self) -> NDArray[np.uint8]:
        """(k,) uint8: how the triangles meet, see PairKind. By exact signs."""

    @property
    def ends(self) -> NDArray[np.float64]:
        """(k, 2, 3) float64: both ends of the common segment, in the unit of the vertices.

        The exact points, each coordinate rounded to the nearest double. Equal for a point, NaN for
        an overlap. The segment of two planes runs along the first normal times the second.
        """

    @property
    def errors(self) -> NDArray[np.float64]:
        """(k,) float64: upper bound of the error of each coordinate of the ends.

        0 if both ends are corners, else half an ulp of the largest coordinate.
        """

    @property
    def parts(self) -> NDArray[np.uint8]:
        """(k, 2, 2) uint8: for each end, the part of each triangle that holds it.

        0 is the inside. 1 to 3 are the edges from corner 0, 1 and 2 to the next corner, 4 to 6 the
        corners. 255 for an overlap.
        """

class Curves:
    """Curves in which surfaces cross, and groups of the rows that cross.

    Curve k has the points `starts[k]` to `starts[k + 1] - 1`. A closed curve has its first point
    again at its end. Segments are one less than points: those of curve k begin at `starts[k] - k`.
    Columns are read-only numpy arrays.
    """

    def __len__(self) -> int: ...

    @property
    def points(self) -> NDArray[np.float64]:
        """(n, 3) float64: points of all curves, curve by curve, in the unit of the vertices."""

    @property
    def starts(self) -> NDArray[np.int64]:
        """(m + 1,) int64: the first point of each curve, and the number of points."""

    @property
    def is_closed(self) -> NDArray[np.bool_]:
        """(m,) bool: whether each curve is closed."""

    @property
    def rows(self) -> NDArray[np.uint32]:
        """(n - m,) uint32: the answer's row of each segment, curve by curve."""

    @property
    def groups(self) -> NDArray[np.uint32]:
        """(m,) uint32: the group of each curve. Rows that share a triangle or an end are in one group."""

    @property
    def row_groups(self) -> NDArray[np.int64]:
        """(k,) int64: the group of each row of the answer; -1 for rows that do not cross."""

class DeviceArray:
    """Array in the memory of the device.

    On a GPU, torch.from_dlpack and cupy.from_dlpack show this memory without a copy. Read it behind
    `submit`, on the device's stream. On a CPU, numpy.from_dlpack takes a copy. The array ends with
    the next call that changes the detector: then taking it raises InvalidArgumentError.
    """

    def __dlpack__(
        self,
        *,
        stream: int | None = None,
        max_version: tuple[int, int] | None = None,
        dl_device: tuple[int, int] | None = None,
        copy: bool | None = None,
    ) -> Any: ...

    def __dlpack_device__(self) -> tuple[int, int]: ...

    @property
    def __cuda_array_interface__(self) -> dict[str, Any]: ...

    @property
    def shape(self) -> tuple[int, ...]:
        """Dimensions of the array."""

class DeviceAnswer:
    """Answer of a submitted query in the memory of the device.

    Vertices, triangles and edges are numbered through all bodies: see `starts`.
    """

    @property
    def entries(self) -> Literal["triangle pairs", "contacts", "near pairs", "nearest triangles", "body pairs"]:
        """Kind of rows: "triangle pairs", "contacts", "near pairs", "nearest triangles" or "body pairs"."""

    @property
    def lists(self) -> list[dict[str, DeviceArray]]:
        """Lists of rows, each a dictionary of columns with room for more rows than there are.

        `status` counts the rows in use.

        - Triangle pairs: triangles (room, 2) int32.
        - Contacts: feature_a, feature_b (room,) int32, toi, toi_upper (room,) float64, state (room,)
          uint32: 1 contact, 2 undecided, 4 added if the iterations ended. An Earliest query has those
          at its time, in no order, if `prepare` was called with `first_contacts=True`; else none.
        - Near pairs: feature_a, feature_b, squared_distances (room,) float64, at (room, 2) float64:
          the weights of the face's corners 1 and 2, or the place on each edge.
        - Nearest triangles: triangles, distances, at (room, 2, 2), points (room, 2, 3). One row, or a
          row for each pair of bodies in no order.
        - Body pairs: bodies (room, 2) int32, in no order.
        """

    @property
    def geometry(self) -> dict[str, DeviceArray] | None:
        """Geometry of rows, if `prepare` was called with `geometry=True`; else None.

        A dictionary of columns, as of `Detector.geometry`: vertices (room, 4) int32 through all bodies,
        signed_weights (room, 4), points (room, 2, 3), normals (room, 3), distances (room,) float64.
        Rows are numbered through both lists. Unused rows are zeros, so they weigh nothing.
        """
    @property
    def least_by_vertex(self) -> DeviceArray | None:
        """(vertices,) float64: least time or distance of each vertex, infinite without a row.

        None unless `prepare` was called with `least_by_vertex=True`.
        """
    @property
    def grouped(self) -> dict[str, tuple[DeviceArray, DeviceArray]]:
        """Rows by feature, for each name in `grouped` of `prepare`: (starts, rows), int32.

        Rows of feature i are rows[starts[i]:starts[i + 1]], ascending; an unused place is -1. Rows are
        numbered through both lists, features through all bodies.
        """
    @property
    def status(self) -> DeviceArray:
        """(5,) int64: counts of the submission, and whether its answer is whole.

        - 0: rows of the first list, or the vertex/face rows of an ordered one.
        - 1: rows of the second list, or the edge/edge rows of an ordered one.
        - 2: number of lists that were too short. Unless it is 0, rows are missing: use `collect`.
        - 3: 0, or the vertex with a coordinate that cannot be used.
        - 4: triangle pairs that cross at the start of the step; -1 if they are not counted.
        """

    @property
    def earliest(self) -> DeviceArray | None:
        """(1,) float64: time of an Earliest query, NaN if nothing meets; None for other queries."""

    @property
    def edges(self) -> DeviceArray:
        """(edges, 2) int32: the vertices of each edge; no rows for Discrete and Distance."""

    @property
    def starts(self) -> NDArray[np.uint32]:
        """(bodies + 1, 3) uint32: first vertex, triangle and edge of each body, and their numbers at the end."""

    @property
    def is_ordered(self) -> bool:
        """Whether rows are in canonical order, vertex/face and edge/edge rows in one list."""

class Detector:
    """Scene on a device, which answers queries step after step.

    All queries share one memory and one upload of positions. Memory of a query is taken when it is
    first used; the same query with other numbers takes none and builds nothing. An answer depends on
    the query and on positions alone.

    - `scene`: a Scene, or one Body, whose number is then 0.
    - `device`: default Device(), a GPU if there is one.

    Other threads of Python run during a call. Threads that share a device take turns.
    """

    def __new__(cls, scene: Scene | Body, *, device: Device | None = None) -> Detector: ...

    def update(self, inputs: Motions) -> None:
        """Move bodies for the next queries.

        - `inputs`: a mapping from body numbers or names to motions. Deformable bodies take positions,
          (n, 3) numbers, or a tuple of two such arrays for the start and the end of a step. Rigid
          bodies take a Pose or a (4, 4) array, or a tuple of two, or a PoseStep.

        Other bodies rest where they are, or where their step ended. Discrete, Near and Distance use
        the start of a step. Arrays of the detector's GPU are read in place, and so are packed numpy
        arrays on a CPU. On a GPU, write to them only on the device's stream or after the next answer.

        Raises InputError for positions that cannot be used, InvalidArgumentError for bodies that do
        not exist and motions that do not fit: then nothing has moved. Positions on a GPU are checked
        by the next query.
        """

    def update_poses(
        self,
        ids: Iterable[Key],
        positions: Array,
        quaternions: Array,
        *,
        end_positions: Array = None,
        end_quaternions: Array = None,
    ) -> None:
        """Move many rigid bodies at once, by arrays of poses with a row a body.

        - `ids`: numbers or names of the bodies.
        - `positions`: (n, 3) numbers, the translations.
        - `quaternions`: (n, 4) numbers, unit quaternions (x, y, z, w).
        - `end_positions`, `end_quaternions`: poses at the end of a step, see PoseStep. Default: bodies
          rest.

        As `update` with a Pose for each. Arrays of the detector's GPU are read in place. Raises
        InvalidArgumentError for other numbers of rows, and for a body that does not exist, is named
        twice or is not rigid; InputError for an invalid pose. It names the row and the body.
        """

    def query(self, query: Query[_A]) -> _A:
        """Return the answer to a query, of the bodies where they are.

        Raises InvalidArgumentError for Continuous and Earliest if the last update gave no body two
        ends, and OutOfMemory if the answer has no room. There is no partial answer.
        """

    def step(self, inputs: Motions, query: Query[_A]) -> _A:
        """Move bodies and return the answer to a query, in one submission.

        As `update` and `query`. An error of the motions or of the query has moved nothing.
        """

    def near(self, distance: float) -> NearPairs:
        """Return features within a distance at t = 0: the answer to Near.

        - `distance`: a length above 0, in the unit of the vertices. It may be 0 if a body has a thickness.
        """

    def discrete(self, *, adjacent: bool = False, only_crossing: bool = False) -> TrianglePairs:
        """Return triangles that share a point at t = 0: the answer to Discrete.

        - `adjacent`: also test triangles with a common vertex, for points beyond that vertex or edge.
        - `only_crossing`: leave out triangles that touch without crossing.
        """

    def continuous(
        self,
        *,
        tolerance: float | None = None,
        min_separation: float = 0.0,
        max_iterations: int | None = None,
        assume_free: bool = False,
        approaching: bool = False,
    ) -> Contacts:
        """Return all contacts of the step: the answer to Continuous.

        - `tolerance`: accuracy of times, as a length of at least 0. Default: 1e-4 of the mean edge.
        - `min_separation`: features that come this near count as contacts, a length of at least 0.
        - `max_iterations`: most iterations for a pair, at least 1. Default 4096.
        - `assume_free`: skip the count of triangle pairs that cross at the start of the step.
        - `approaching`: features within `min_separation` at the start are in contact from when they
          come nearer than there.

        Raises InvalidArgumentError if the last update named bodies, and none got two ends.
        """

    def earliest(
        self,
        *,
        tolerance: float | None = None,
        min_separation: float = 0.0,
        max_iterations: int | None = None,
        assume_free: bool = False,
        approaching: bool = False,
    ) -> FirstContact:
        """Return the first contact of the step: the answer to Earliest.

        - `tolerance`: accuracy of the time, as a length of at least 0. Default: 1e-4 of the mean edge.
        - `min_separation`: features that come this near count as contacts, a length of at least 0.
        - `max_iterations`: most iterations for a pair, at least 1. Default 4096.
        - `assume_free`: skip the count of triangle pairs that cross at the start of the step.
        - `approaching`: features within `min_separation` at the start are in contact from when they
          come nearer than there.

        Raises InvalidArgumentError if the last update named bodies, and none got two ends.
        """

    def first_contacts(self, first: FirstContact) -> Contacts:
        """Return the contacts at the time of an earliest answer, as an answer to Continuous.

        - `first`: FirstContact of this detector. Bodies must not have moved since.

        They are the rows of Continuous whose `toi` it is. The step is tested again, up to that time; with a
        `min_separation` all of it.
        Raises InvalidArgumentError if nothing begins at that time where the bodies are now.
        """

    def distance(self) -> NearestTriangles:
        """Return the nearest two bodies at t = 0, and their distance: the answer to Distance."""

    def body_pairs(self, *, first: int | None = None) -> TouchingBodies:
        """Return pairs of bodies that share a point at t = 0: the answer to BodyPairs.

        - `first`: list the first pairs alone, at least 1. With 1 the work ends early. Default: all.
        """

    def body_distances(self, within: float) -> NearestBodies:
        """Return the least distance of each two bodies at t = 0: the answer to BodyDistances.

        - `within`: largest distance of a row, a length of at least 0, in the unit of the vertices.
        """

    @overload
    def geometry(self, answer: Contacts | NearPairs) -> Geometry:
        """Return where the features or triangles of an answer's rows meet.

        - `answer`: an answer of this detector. Bodies must not have moved since.

        Returns Geometry for Contacts and NearPairs: vertices, weights, points and normals. Returns
        PairGeometry for TrianglePairs: how they meet, and the segment in which they do.
        Raises InvalidArgumentError for other answers, and for those of the solver "moller".
        """
    @overload
    def geometry(self, answer: TrianglePairs) -> PairGeometry:
        """Return where the features or triangles of an answer's rows meet.

        - `answer`: an answer of this detector. Bodies must not have moved since.

        Returns Geometry for Contacts and NearPairs: vertices, weights, points and normals. Returns
        PairGeometry for TrianglePairs: how they meet, and the segment in which they do.
        Raises InvalidArgumentError for other answers, and for those of the solver "moller".
        """

    def grouped(
        self, answer: Answer, body: Key, by: Literal["vertex", "edge", "face", "corner"] = "vertex"
    ) -> tuple[NDArray[np.uint32], NDArray[np.uint32]]:
        """Group the rows of an answer by features of a body.

        - `answer`: Contacts, NearPairs or TrianglePairs of this detector.
        - `body`: its number or name.
        - `by`: "vertex", "edge" and "face" are the features of rows. "face" is also each triangle of a
          pair. "corner" is each vertex that takes part in a row.

        Returns two uint32 arrays, starts and rows: the rows of feature i are
        rows[starts[i]:starts[i + 1]], ascending. Raises InvalidArgumentError for other answers.
        """

    def least_by_vertex(self, answer: Answer, body: Key) -> NDArray[np.float64]:
        """Return the least time of contact, or the least distance, of each vertex of a body.

        - `answer`: Contacts or NearPairs of this detector.
        - `body`: its number or name.

        Returns a float64 array: over the rows in which the vertex takes part, inf without one.
        Vertices that stop at different times leave the straight lines that were tested: query the
        shortened step again.
        """

    def curves(self, answer: TrianglePairs) -> Curves:
        """Return the curves in which surfaces cross, chained from the rows that cross.

        - `answer`: TrianglePairs of this detector. Bodies must not have moved since.

        Segments are joined by the vertex, edge or face of each body that holds their ends, never by
        coordinates. A curve ends at a border, at a seam of equal vertices, and along an edge on a face. It
        also ends in a point of three surfaces.
        Raises InvalidArgumentError for other answers.
        """

    def summary(self, answer: Answer) -> dict[str, Any]:
        """Return all figures of an answer as a dictionary, as the program prints them with --json.

        Counts, caveats, notes, milliseconds by stage. Takes the answers that `geometry` takes, and
        those of other queries too.
        """

    def plan(self, query: Query[Any]) -> dict[str, Any]:
        """Return the kernels, memory and transfers of a query as a dictionary.

        They are counted: the query runs.
        """

    def prepare(
        self,
        inputs: Motions,
        queries: Iterable[Query[Any]],
        *,
        geometry: bool = False,
        least_by_vertex: bool = False,
        grouped: Sequence[Literal["vertex", "edge", "face", "corner"]] | None = None,
        first_contacts: bool = False,
    ) -> None:
        """Prepare submissions: run the queries, load every kernel and take all memory.

        After it, `submit` allocates nothing and waits for nothing, until another call changes the
        detector.

        - `inputs`: as of `update`, arrays that stay where they are: of the GPU, or packed numpy
          arrays on a CPU. Write new positions into them. They are held while prepared.
        - `queries`: a list of queries, answered by every submission. No two may differ in numbers
          alone.
        - `geometry`, `least_by_vertex`, `grouped`: parts of the answers that submissions also make on
          the device. `on_device` has them. `grouped` has "vertex", "edge", "face" or "corner".
        - `first_contacts`: `lists` of an Earliest query have the contacts at its time, as of
          `Detector.first_contacts`, in no order. Other parts are of these rows too.

        Raises InvalidArgumentError for a part that no query has.
        """

    def prepare_poses(
        self,
        ids: Iterable[Key],
        positions: Array,
        quaternions: Array,
        queries: Iterable[Query[Any]],
        *,
        end_positions: Array = None,
        end_quaternions: Array = None,
        geometry: bool = False,
        least_by_vertex: bool = False,
        grouped: Sequence[Literal["vertex", "edge", "face", "corner"]] | None = None,
        first_contacts: bool = False,
    ) -> None:
        """Prepare submissions of many rigid bodies that move by arrays of poses, a row a body.

        Other bodies rest where they are.

        - `ids`, `positions`, `quaternions`, `end_positions`, `end_quaternions`: as of `update_poses`,
          arrays that stay where they are: of the GPU, or packed numpy arrays on a CPU. Write new poses into
          them. They are held while prepared.
        - `queries`, `geometry`, `least_by_vertex`, `grouped`, `first_contacts`: as of `prepare`.
        """

    @property
    def is_prepared(self) -> bool:
        """Whether `submit` may be called, and a graph that recorded it launched again."""

    def submit(self) -> None:
        """Launch the prepared queries on the device's stream, and return at once.

        A graph may record it (torch.cuda.graph, cupy). On a CPU it is done when it returns. Raises
        InvalidArgumentError if the detector is not prepared.
        """

    def on_device(self, query: Query[Any]) -> DeviceAnswer | None:
        """Return the answer to a prepared query in device memory; None if it is not prepared.

        None also if no two bodies may meet.
        """

    def collect(self, query: Query[_A]) -> _A:
        """Wait for the last submission, and return the answer to one of its queries.

        If a list was too short it grows and the query runs again: the answer is whole, and the
        detector is no longer prepared. A query that was not prepared runs too.
        """

    def rebuild(self) -> None:
        """Rebuild tiles and trees: pays if bodies have moved far from where they were built.

        Queries do so by themselves. Submissions do not.
        """

    def interrupt(self) -> None:
        """End the call of another thread or, if none runs, the next call.

        That call raises Interrupted, and the detector can be used again. Its motions were taken. On
        the main thread Ctrl-C does the same, and raises KeyboardInterrupt.
        """

    def add(self, body: Body) -> int:
        """Add a body, and return its number."""

    def remove(self, body: Key) -> None:
        """Remove a body, by number or name. The next body that is added may take its number."""

    def replace(self, body: Key, by: Body) -> None:
        """Replace a body, by number or name."""

    def leave_out(self, pairs: Iterable[tuple[Key, Key]]) -> None:
        """Replace the list of pairs of bodies that are not tested against each other, by any query.

        - `pairs`: [(a, b), ...], numbers or names of bodies, as the links of a robot that share a joint.
          Order and repeats do not matter; [] leaves out none.

        A body that is removed takes its pairs with it, one that is replaced keeps them. Another list
        ends the preparation of submissions, and the next query builds tiles or trees.
        Raises InvalidArgumentError for a body that does not exist, and for a body with itself: then the
        list is as before.
        """

    def set_thickness(self, body: Key, thickness: Union[float, Array]) -> None:
        """Set the thickness of a body, from the next query on.

        - `body`: its number or name.
        - `thickness`: a radius, a length of at least 0, or one for each vertex.

        Another thickness ends the preparation of submissions, and the next query builds tiles or trees.
        Raises InvalidArgumentError for a thickness that is no length: then it is as before.
        """

    @property
    def left_out(self) -> list[tuple[int, int]]:
        """Pairs of bodies that are left out: the smaller number first, ascending."""

    def exclude(
        self,
        body: Key,
        *,
        ring: int | None = None,
        within: float | None = None,
        rest: Array | None = None,
        faces: Array | None = None,
    ) -> None:
        """Replace the exclusions of a body: see Scene.exclude for the arguments.

        A body that is removed or replaced loses its exclusions: its vertices may have other numbers.
        Other exclusions end the preparation of submissions, and the next query builds tiles or trees.

        Raises as Scene.exclude does. Then nothing has changed.
        """

    def exclude_pairs(self, body: Key, other: Key, pairs: Array) -> None:
        """Replace the list of pairs of vertices of two bodies: see Scene.exclude_pairs for the arguments.

        A body that is removed or replaced takes its lists with it. Another list ends the preparation of
        submissions, and the next query builds tiles or trees.

        Raises as Scene.exclude_pairs does. Then the list is as before.
        """

    def excluded_pairs(self, body: Key, other: Key) -> NDArray[np.uint32]:
        """Pairs of vertices of two bodies that are left out, as an (n, 2) array, ascending."""

    def download_positions(self, body: Key) -> tuple[NDArray[Any], NDArray[Any]] | tuple[Pose, Pose]:
        """Return the place of a body at the start and the end of its step, copied to the host.

        Two (n, 3) arrays, or two Pose of a rigid body; both are equal if the body rests. Cost: a copy
        of all vertices if only the device has them, and a wait.
        """

    def pose(self, body: Key) -> Pose:
        """Return the pose of a rigid body; in a step, the pose at its start. Cost: see `download_positions`."""

    def poses(self, body: Key) -> tuple[Pose, Pose]:
        """Return the poses of a rigid body at the start and the end of its step; equal if it rests."""

    def name(self, body: Key) -> str:
        """Return the name of a body."""

    def id(self, name: str) -> int:
        """Return the number of the one body with that name.

        Raises InvalidArgumentError if no body has the name, or several have; it lists them.
        """

    @property
    def bodies(self) -> list[int]:
        """Numbers of all bodies, ascending."""

    @property
    def builds(self) -> int:
        """Number of times that tiles or trees were built."""

    @property
    def tolerance(self) -> float:
        """Smallest default tolerance of a pair of bodies, a length."""

    @property
    def largest_tolerance(self) -> float:
        """Largest default tolerance of a pair of bodies, a length."""

    @property
    def device(self) -> Device:
        """Device of this detector."""

class MultiDetector:
    """Scene on several devices of one host, which divide the work of each query.

    Each device has all positions and finds the pairs of its share. Answers and hashes are those of a
    Detector. The first frame is divided evenly, the next ones by the times of the last.

    - `scene`: a Scene, or one Body, whose number is then 0.
    - `devices`: at least one Device, such as [Device(gpu=0), Device(gpu=1)].

    Takes Discrete, Continuous, Earliest and Near. Each device has a copy of positions. Raises
    InvalidArgumentError without devices.
    """

    def __new__(cls, scene: Scene | Body, devices: Sequence[Device]) -> MultiDetector: ...

    def update(self, inputs: Motions) -> None:
        """Move bodies for the next queries: see Detector.update for the arguments.

        Arrays may be on any of the GPUs; the others get copies. All have read them when the call
        returns.

        Raises as Detector.update does, and InvalidArgumentError for arrays of another GPU, or of a GPU if
        a device is a CPU: then nothing has moved.
        """

    def query(self, query: Query[_A]) -> _A:
        """Return the answer to a query, of the bodies where they are.

        Raises as Detector.query does, and InvalidArgumentError for a query that cannot be divided: Distance,
        BodyPairs and BodyDistances.
        """

    def step(self, inputs: Motions, query: Query[_A]) -> _A:
        """Move bodies and return the answer to a query.

        As `update` and `query`. An error of the motions or of the query has moved nothing.
        """

    def prepare(
        self,
        inputs: Motions,
        queries: Iterable[Query[Any]],
        *,
        geometry: bool = False,
        least_by_vertex: bool = False,
        grouped: Sequence[Literal["vertex", "edge", "face", "corner"]] | None = None,
        first_contacts: bool = False,
    ) -> None:
        """Prepare submissions: see Detector.prepare.

        Arrays may be on any of the GPUs; every submission copies them to the others. The work is
        divided by what it costs now, until the next preparation. Raises InvalidArgumentError for
        `first_contacts`: each GPU has the time of its share alone.
        """

    @property
    def is_prepared(self) -> bool:
        """Whether `submit` may be called."""

    def submit(self) -> None:
        """Launch the prepared queries on the streams of all GPUs: see Detector.submit.

        The stream of a GPU that has arrays goes on when the others have their copies. No graph can
        record it.
        """

    def on_device(self, query: Query[Any]) -> list[DeviceAnswer] | None:
        """Return the answers to a prepared query in device memory, one a device; None if it is not prepared.

        Each has the rows of the device's share: see Detector.on_device. An Earliest query has
        the time of each share.
        """

    def collect(self, query: Query[_A]) -> _A:
        """Wait for the last submission, and return the answer to one of its queries: see Detector.collect."""

    @overload
    def geometry(self, answer: Contacts | NearPairs) -> Geometry:
        """Return where the features or triangles of an answer's rows meet: see Detector.geometry."""
    @overload
    def geometry(self, answer: TrianglePairs) -> PairGeometry:
        """Return where the features or triangles of an answer's rows meet: see Detector.geometry."""

    def grouped(
        self, answer: Answer, body: Key, by: Literal["vertex", "edge", "face", "corner"] = "vertex"
    ) -> tuple[NDArray[np.uint32], NDArray[np.uint32]]:
        """Group the rows of an answer by features of a body: see Detector.grouped."""

    def least_by_vertex(self, answer: Answer, body: Key) -> NDArray[np.float64]:
        """Return the least time of contact, or the least distance, of each vertex: see Detector.least_by_vertex."""

    def curves(self, answer: TrianglePairs) -> Curves:
        """Return the curves in which surfaces cross: see Detector.curves."""

    def first_contacts(self, first: FirstContact) -> Contacts:
        """Return the contacts at the time of an earliest answer: see Detector.first_contacts."""

    def shares(self, query: Query[Any]) -> list[dict[str, Any]]:
        """Return the part of each device in the last frame of a query; empty before the first frame.

        A dictionary a device: `device`, its name; `tiles`, its part of them, 0 to 1; `ms`, milliseconds by
        its own clock.
        """

    def interrupt(self) -> None:
        """End the call of another thread or, if none runs, the next call: see Detector.interrupt."""

    def add(self, body: Body) -> int:
        """Add a body, and return its number."""

    def remove(self, body: Key) -> None:
        """Remove a body, by number or name. The next body that is added may take its number."""

    def replace(self, body: Key, by: Body) -> None:
        """Replace a body, by number or name."""

    def leave_out(self, pairs: Iterable[tuple[Key, Key]]) -> None:
        """Replace the list of pairs of bodies that are not tested: see Detector.leave_out."""

    @property
    def left_out(self) -> list[tuple[int, int]]:
        """Pairs of bodies that are left out: the smaller number first, ascending."""

    def set_thickness(self, body: Key, thickness: Union[float, Array]) -> None:
        """Set the thickness of a body, from the next query on: see Detector.set_thickness."""

    def exclude(
        self,
        body: Key,
        *,
        ring: int | None = None,
        within: float | None = None,
        rest: Array | None = None,
        faces: Array | None = None,
    ) -> None:
        """Replace the exclusions of a body: see Scene.exclude for the arguments, and Detector.exclude."""

    def exclude_pairs(self, body: Key, other: Key, pairs: Array) -> None:
        """Replace the list of pairs of vertices of two bodies: see Detector.exclude_pairs."""

    @property
    def bodies(self) -> list[int]:
        """Numbers of all bodies, ascending."""

    @property
    def devices(self) -> list[Device]:
        """Devices of this detector."""
