// nearmiss: collision detection for deformable triangle meshes, on the CPU and on NVIDIA GPUs, to the same bit. C99 and C++.
//
// Made by cbindgen from c/src; see c/tests/header.rs.
//
// - A `NearmissDevice` is where work runs, a `NearmissScene` says which bodies there are, a `NearmissDetector` has both and a
//   query, and is asked frame after frame. Each frame gives a `NearmissAnswer`. All four are handles: made by a call whose
//   name ends with `new` or that fills a `NearmissX **`, freed by `nearmiss_..._free`, which takes NULL too.
// - Handles do not need each other: a device may be freed before its detectors, a scene as soon as its detector is made.
//   What a call gives as a pointer into a handle stays there until that handle is freed, unless said otherwise.
// - A call that can fail returns a `NearmissCode`, 0 for success, and tells more in a `NearmissError` of the caller where that
//   is not NULL. Where it fails a handle that it would have made is NULL, and other results are not written.
// - Results go where a pointer says. NULL is refused with `NEARMISS_INVALID_ARGUMENT`, but where it is said to mean something. Other pointers
//   must be of the type that the declaration says, as C asks; results of one call may not overlap.
// - A handle is used by one thread at a time; two handles, by two. Detectors of one device are one handle in this, and making one is
//   a use of them; a device's name, kind, limit and end are not: `nearmiss_device_name`, `_is_gpu`, `_limit` and `_free` may be
//   called while another thread works with its detectors. An answer is a handle by itself.
//   `nearmiss_interrupt` and `nearmiss_interrupt_clear` may be called from any thread and from a signal handler, at any time.
// - All that handles share is threads of the host, one a processor, which prepare bodies and put answers in order: the first
//   CPU or detector of the process starts them, and they stay. A process that was forked since has none of them: there a
//   call that would need them fails with `NEARMISS_INVALID_ARGUMENT`. Start processes by `posix_spawn` or `exec`, or fork before.
// - Positions are floats or doubles in any unit, of a size up to 2^480, and finite where a triangle uses them; lengths are in that
//   unit, times are parts of a step, from 0 to 1. All indices count from 0. Structs of options come from a function that fills in
//   what is usual, `nearmiss_body()` and `nearmiss_query()`: then set what differs.
// - A fault of the library comes back as `NEARMISS_BUG`, never as a crash. A detector in which that happened refuses all else.


#ifndef NEARMISS_H
#define NEARMISS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

// The version of this header, which changes whenever a struct or a function does. Compare it with `nearmiss_abi()` before any other call: one
// that takes or returns a struct of another version writes where it may not.
#define NEARMISS_ABI 2

// Bytes of the text of an error.
#define NEARMISS_TEXT 1016

// How a call ended: a code for each kind of error, grouped by who must act.
enum NearmissCode
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : uint32_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
    // Done.
    NEARMISS_OK = 0,
    // An argument that does not exist or does not go with the others, whatever the data: an
    // option, a name, a kind, the number of a body, a pointer. Choose again.
    NEARMISS_INVALID_ARGUMENT = 1,
    // Data that cannot be used: numbers of a mesh, of positions or of a pose. Correct the data.
    NEARMISS_INPUT = 2,
    // A result could not be written.
    NEARMISS_OUTPUT = 3,
    // The machine refused. See what its driver says.
    NEARMISS_DEVICE = 4,
    // A measurement is worse than an earlier one.
    NEARMISS_REGRESSION = 5,
    // Memory ran out. There is no answer, and nothing was lost in silence.
    NEARMISS_OUT_OF_MEMORY = 6,
    // The GPU's kernels were made from other sources than the library. Build again.
    NEARMISS_STAMP = 7,
    // A fault of nearmiss itself. Tell us.
    NEARMISS_BUG = 8,
    // A `NearmissInterrupt` has ended the call. There is no answer, and the detector can be used
    // again.
    NEARMISS_INTERRUPTED = 9,
};
#ifndef __cplusplus
#if __STDC_VERSION__ >= 202311L
typedef enum NearmissCode NearmissCode;
#else
typedef uint32_t NearmissCode;
#endif // __STDC_VERSION__ >= 202311L
#endif // __cplusplus

// Which features meet.
enum NearmissKind
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : uint32_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
    // `a` is a vertex, `b` a face of the same body or of one with a larger number.
    NEARMISS_VF = 0,
    // `a` is a face, `b` a vertex of a body with a larger number.
    NEARMISS_FV = 1,
    // Two edges, numbered by (larger vertex, smaller vertex), ascending.
    NEARMISS_EE = 2,
};
#ifndef __cplusplus
#if __STDC_VERSION__ >= 202311L
typedef enum NearmissKind NearmissKind;
#else
typedef uint32_t NearmissKind;
#endif // __STDC_VERSION__ >= 202311L
#endif // __cplusplus

// How sure an answer is.
enum NearmissStatus
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : uint32_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
    // A solver that can be wrong says so.
    NEARMISS_CONTACT = 0,
    // They meet, proven, first in `[toi, toi_upper]`.
    NEARMISS_CERTIFIED = 1,
    // They come nearer than the tolerance, or the budget ended; if they meet, not before `toi`. Proven as well.
    NEARMISS_UNDECIDED = 2,
};
#ifndef __cplusplus
#if __STDC_VERSION__ >= 202311L
typedef enum NearmissStatus NearmissStatus;
#else
typedef uint32_t NearmissStatus;
#endif // __STDC_VERSION__ >= 202311L
#endif // __cplusplus

// What is nearest of two features.
enum NearmissClosest
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : uint32_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
    // A vertex and the inside of a face.
    NEARMISS_VERTEX_FACE = 0,
    // A vertex and the inside of an edge.
    NEARMISS_VERTEX_EDGE = 1,
    // Two vertices.
    NEARMISS_VERTEX_VERTEX = 2,
    // The insides of two edges.
    NEARMISS_EDGE_EDGE = 3,
};
#ifndef __cplusplus
#if __STDC_VERSION__ >= 202311L
typedef enum NearmissClosest NearmissClosest;
#else
typedef uint32_t NearmissClosest;
#endif // __STDC_VERSION__ >= 202311L
#endif // __cplusplus

// What the entries of a list on the device are. Vertices, triangles and edges are numbered through all bodies.
enum NearmissEntries
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : uint32_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
    // `NearmissDevicePair`: two triangles.
    NEARMISS_TRIANGLE_PAIRS = 0,
    // `NearmissDeviceHit`: a vertex and a face, or two edges, and when they first meet. None of an earliest query.
    NEARMISS_CONTACTS = 1,
    // `NearmissDeviceNearHit`: a vertex and a face, or two edges, and where they are nearest.
    NEARMISS_NEAR_PAIRS = 2,
    // `NearmissDeviceNearest`: two triangles, how far apart they are, and where.
    NEARMISS_NEAREST = 3,
};
#ifndef __cplusplus
#if __STDC_VERSION__ >= 202311L
typedef enum NearmissEntries NearmissEntries;
#else
typedef uint32_t NearmissEntries;
#endif // __STDC_VERSION__ >= 202311L
#endif // __cplusplus

// Which machine to take.
enum NearmissBackend
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : uint32_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
    // The CPU.
    NEARMISS_CPU = 0,
    // The first NVIDIA GPU.
    NEARMISS_CUDA = 1,
    // The GPU where there is one, else the CPU.
    NEARMISS_AUTO = 2,
};
#ifndef __cplusplus
#if __STDC_VERSION__ >= 202311L
typedef enum NearmissBackend NearmissBackend;
#else
typedef uint32_t NearmissBackend;
#endif // __STDC_VERSION__ >= 202311L
#endif // __cplusplus

// The kind of numbers that lie in a memory.
enum NearmissNumber
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : uint32_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
    // Single precision.
    NEARMISS_F32 = 0,
    // Double precision. Never rounded to singles.
    NEARMISS_F64 = 1,
};
#ifndef __cplusplus
#if __STDC_VERSION__ >= 202311L
typedef enum NearmissNumber NearmissNumber;
#else
typedef uint32_t NearmissNumber;
#endif // __STDC_VERSION__ >= 202311L
#endif // __cplusplus

// What a body does from frame to frame.
enum NearmissBodyKind
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : uint32_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
    // It stands where it was made: built once, costs nothing a frame, and is never tested against what is static too.
    NEARMISS_FIXED = 0,
    // It moves as one, by poses.
    NEARMISS_RIGID = 1,
    // Each vertex moves by itself.
    NEARMISS_DEFORMABLE = 2,
};
#ifndef __cplusplus
#if __STDC_VERSION__ >= 202311L
typedef enum NearmissBodyKind NearmissBodyKind;
#else
typedef uint32_t NearmissBodyKind;
#endif // __STDC_VERSION__ >= 202311L
#endif // __cplusplus

// Whether a body is tested against itself. Deformable bodies are by default, rigid bodies if it is
// on, static bodies never.
enum NearmissSelfCollision
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : uint32_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
    // The default of its kind, also of a struct of zeros.
    NEARMISS_SELF_COLLISION_DEFAULT = 0,
    // It is; refused for static bodies.
    NEARMISS_SELF_COLLISION_ON = 1,
    // It is not.
    NEARMISS_SELF_COLLISION_OFF = 2,
};
#ifndef __cplusplus
#if __STDC_VERSION__ >= 202311L
typedef enum NearmissSelfCollision NearmissSelfCollision;
#else
typedef uint32_t NearmissSelfCollision;
#endif // __STDC_VERSION__ >= 202311L
#endif // __cplusplus

// What an input says.
enum NearmissInputKind
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : uint32_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
    // A deformable body stands at `positions[0]`.
    NEARMISS_AT = 0,
    // A deformable body moves from `positions[0]` to `positions[1]`, each vertex in a straight
    // line. Discrete, near and distance queries test it at `positions[0]`; it rests at
    // `positions[1]` if the next frame does not name it. So of poses.
    NEARMISS_STEP = 1,
    // A rigid body stands in `poses[0]`.
    NEARMISS_POSE = 2,
    // A rigid body moves from `poses[0]` to `poses[1]`, each vertex in a straight line: give steps in which it turns little.
    NEARMISS_POSES = 3,
};
#ifndef __cplusplus
#if __STDC_VERSION__ >= 202311L
typedef enum NearmissInputKind NearmissInputKind;
#else
typedef uint32_t NearmissInputKind;
#endif // __STDC_VERSION__ >= 202311L
#endif // __cplusplus

// What is asked of a scene.
enum NearmissQueryKind
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : uint32_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
    // Which triangle pairs share a point now? Answers `nearmiss_answer_triangle_pairs`.
    NEARMISS_DISCRETE = 0,
    // Which vertex/face and edge/edge pairs meet within the step, and when first? Answers `nearmiss_answer_contacts`.
    NEARMISS_CONTINUOUS = 1,
    // When does the first of them meet? Answers `nearmiss_answer_earliest`, and
    // `nearmiss_answer_is_free`.
    NEARMISS_EARLIEST = 2,
    // Which vertex/face and edge/edge pairs are within a distance now, and where? Answers `nearmiss_answer_near_pairs`.
    NEARMISS_NEAR = 3,
    // How far apart are the two bodies that are nearest now, and where? Answers `nearmiss_answer_nearest`.
    NEARMISS_DISTANCE = 4,
};
#ifndef __cplusplus
#if __STDC_VERSION__ >= 202311L
typedef enum NearmissQueryKind NearmissQueryKind;
#else
typedef uint32_t NearmissQueryKind;
#endif // __STDC_VERSION__ >= 202311L
#endif // __cplusplus

// The answer to a frame, with the figures of its making. It changes no more, and needs neither detector nor device.
typedef struct NearmissAnswer NearmissAnswer;

// A scene on a device, asked frame after frame.
typedef struct NearmissDetector NearmissDetector;

// A machine that runs kernels, and its memory.
typedef struct NearmissDevice NearmissDevice;

// A handle that ends calls early. Any thread may use it at any time, until it is freed.
typedef struct NearmissInterrupt NearmissInterrupt;

// Bodies, by their numbers.
typedef struct NearmissScene NearmissScene;

// Two triangles that share a point.
typedef struct {
    // Their bodies, the smaller number first.
    uint32_t bodies[2];
    // Their indices in those; of one body the smaller first.
    uint32_t triangles[2];
} NearmissTrianglePair;

// What a call has to say, in memory of the caller. It need not be initialised; a call that succeeds clears it.
typedef struct {
    // What the call returned.
    NearmissCode code;
    // Bytes of the whole text without its end, those that had no room included.
    uint32_t length;
    // One sentence that says what to do, in UTF-8, with a zero at its end; cut where it has no room.
    char text[NEARMISS_TEXT];
} NearmissError;

// Two features that meet within the step, or, of a query with a separation, that come so near.
typedef struct {
    // Which features.
    NearmissKind kind;
    // How sure that is.
    NearmissStatus status;
    // The bodies of both, the smaller number first.
    uint32_t bodies[2];
    // The first feature's index in its body.
    uint32_t a;
    // The second feature's index in its body.
    uint32_t b;
    // First time of contact, in [0, 1]; by a certified solver not after it.
    double toi;
    // The time by which they have met, in [toi, 1]; of an undecided pair the end of the step.
    double toi_upper;
} NearmissContact;

// Two features that are within a distance of each other, and where they are nearest.
typedef struct {
    // Which features.
    NearmissKind kind;
    // What is nearest of the two.
    NearmissClosest closest;
    // The bodies of both, the smaller number first.
    uint32_t bodies[2];
    // The first feature's index in its body.
    uint32_t a;
    // The second feature's index in its body.
    uint32_t b;
    // Their squared distance: its root is off by 192 half ulps of their extent at most. A square
    // below 2^-1022 has fewer digits, one below 2^-1075 is 0, though the features may be apart.
    double squared_distance;
    // Of a vertex and a face the weights of the face's corners; of two edges how far along `a` and along `b`, from the end of the larger
    // index (0) to the other (1), and 0.
    double weights[3];
} NearmissNearPair;

// The two triangles of different bodies that are nearest, and where.
typedef struct {
    // Their bodies, the smaller number first.
    uint32_t bodies[2];
    // Their indices in those.
    uint32_t triangles[2];
    // How far apart they are: 0 if and only if they share a point, else off by 192 half ulps at
    // most of the larger of two extents: theirs, and that of the truly nearest triangles.
    double distance;
    // Of each the weights of its corners at the nearest point.
    double weights[2][3];
    // Those points.
    double points[2][3];
} NearmissNearest;

// Milliseconds of each stage of a frame, on the device's own clock, but for the last two.
typedef struct {
    // Vertices of the bodies that were moved, with what was uploaded for them.
    double place;
    // Tiles or trees, when they were last made.
    double construct;
    // Volumes of the leaves.
    double fit;
    // All other volumes.
    double refit;
    // Candidates.
    double traverse;
    // Evening out the queues of work, where that is a step of its own.
    double balance;
    // Contacts.
    double narrow;
    // Contacts in canonical order, on a GPU.
    double order;
    // From positions to contacts; placing, construction and ordering not.
    double total;
    // The host's own time until a GPU had the frame to do.
    double launch;
    // What the caller waited for, without the copy into the answer's handle.
    double wall;
} NearmissStages;

// Figures of an answer.
typedef struct {
    // How many contacts or pairs there are; of an earliest query, and of a distance, 1 or 0.
    uint64_t contacts;
    // Triangle pairs that the volumes let through.
    uint64_t triangle_pairs;
    // Pairs that the narrow test was asked.
    uint64_t candidates;
    // How many are neither confirmed nor refuted; of an earliest query 1 if its time is that of
    // such a pair, else 0.
    uint64_t undecided;
    // How often a list was too short and a part of the frame ran again. The answer is whole.
    uint64_t reruns;
    // In how many slices the frame was asked, for want of memory; 1 is the whole at once.
    uint64_t slices;
    // Most bytes of the device's memory held at once, until then, by all detectors of the device.
    uint64_t bytes;
    // Of the canonical answer: the same for equal answers on every machine.
    uint64_t hash;
    // Triangle pairs that share a point at the start of the step; 0 if `is_start_checked` is
    // false.
    uint64_t starts_crossing;
    // Whether the start was checked: of a continuous and an earliest query, unless it assumes a
    // free start.
    bool is_start_checked;
    // How many sentences `nearmiss_answer_degraded` has.
    uint64_t caveats;
    // Times.
    NearmissStages ms;
} NearmissSummary;

// Where the two features of a contact, or of a pair within a distance, are nearest.
typedef struct {
    // The bodies of both.
    uint32_t bodies[2];
    // How many of the vertices are the first feature's: 1 of a vertex, 2 of an edge, 3 of a face. The others are the second one's.
    uint32_t first;
    // The vertices, by their indices in their bodies.
    uint32_t vertices[4];
    // How much of each vertex is in its feature's point.
    double weights[4];
    // The nearest points of both at the time of contact.
    double points[2][3];
    // How far those are apart.
    double distance;
    // From the second feature towards the first, of length 1; zeros where nothing tells a direction.
    double normal[3];
} NearmissGeometry;

// Rows of numbers, one behind the other: positions, three numbers a row. What lies between the rows is not read.
typedef struct {
    // The first number; of memory of a device its address there. NULL where there are no rows.
    const void *data;
    // How many rows.
    size_t count;
    // Bytes from a row to the next, a multiple of the number's size and no less than a row has. 0 for rows without a gap.
    size_t stride;
    // `NEARMISS_F32` or `NEARMISS_F64`.
    uint32_t number;
} NearmissRows;

// A body to be added to a scene: its mesh, what it does, and which bodies it may meet. Begin with `nearmiss_body()`. All that it points to
// is copied by the call that takes it.
typedef struct {
    // What messages call it, in UTF-8; NULL for "a body".
    const char *name;
    // A point a vertex, in memory of the host.
    NearmissRows positions;
    // Three indices of vertices a triangle, without gaps.
    const uint32_t *triangles;
    // How many triangles, at least 1.
    size_t triangle_count;
    // A `NearmissBodyKind`.
    uint32_t kind;
    // A `NearmissSelfCollision`. Deformable bodies are tested against themselves by default, rigid
    // bodies if it is on, static bodies never.
    uint32_t self_collision;
    // Bodies of different environments never meet.
    uint32_t environment;
    // Whether it is in every environment, and `environment` is 0: 0 or 1.
    uint32_t everywhere;
    // Bits of the groups that it is in, at least one: two bodies meet if each is in a group that
    // the other one's mask has.
    uint32_t group;
    // Bits of the groups that it meets; 0 for a body that meets no other.
    uint32_t mask;
} NearmissBody;

// A query and its choices. Begin with `nearmiss_query()`. Names are those of the command line; NULL is the default. A choice that the
// query does not have is refused.
typedef struct {
    // A `NearmissQueryKind`.
    uint32_t kind;
    // Discrete, exact: whether triangles that share a vertex are told too, where they meet beyond it: 0 or 1.
    uint32_t adjacent;
    // Continuous, earliest; certified: the most boxes that are looked at for a pair before it is left undecided; 0 for the default.
    uint32_t budget;
    // Continuous, earliest: whether the start of the step is taken to be free of crossing
    // triangles, and not checked: 0 or 1.
    uint32_t assume_free;
    // Near: how far apart two features may be to be listed, a length above 0.
    double distance;
    // Certified: how near to contact may count as one, a length; times are early by what it takes to move that far, or less. -1 for
    // 1e-4 of the mean edge.
    double tolerance;
    // Certified: features that come this near are in contact, a length; 0 for touching.
    double separation;
    // The test: "exact", "moller" (discrete); "certified", "certified-f64", "certified-f32", "cubic-f64", "cubic-f32" (continuous,
    // earliest); "bounded". "moller" and the cubics can miss contacts, the others cannot.
    const char *solver;
    // The volume: "aabb", "linear", "obb", "obb-child". This and what follows never changes an answer.
    const char *bv;
    // "tree" or "tiles".
    const char *broad;
    // Of tiles: "hilbert", "runs", "median".
    const char *order;
    // Of trees: "levels", "treelets", "bottom-up".
    const char *refit;
    // When tiles or trees are made anew: "never", or "auto", the default.
    const char *rebuild;
} NearmissQuery;

// A rigid motion of the points of a body's mesh: turned first, then moved.
typedef struct {
    // A unit quaternion: x, y, z, w. It may be off unit length by up to 1.2e-4 (2^-13) and is
    // normalised.
    double rotation[4];
    // What is added, in the unit of the positions.
    double translation[3];
} NearmissPose;

// Where a body is at a frame, or at the two ends of a step. Of its parts those are read that `kind` names.
typedef struct {
    // The number of the body.
    uint32_t body;
    // A `NearmissInputKind`.
    uint32_t kind;
    // 0: all is in memory of the host, and copied. 1: it is in memory of the detector's device (on a CPU the host's), is read there,
    // behind all that is on its stream, and must stay until the frame is answered; of a prepared frame until the next input. Poses are then
    // a row of three numbers in `positions` and a row of four in `rotations`.
    uint32_t on_device;
    // A row a vertex; of a pose on the device its translation.
    NearmissRows positions[2];
    // Of a pose on the device: a unit quaternion x, y, z, w, off unit length by at most 1.2e-4.
    NearmissRows rotations[2];
    // Of a rigid body whose poses the host has.
    NearmissPose poses[2];
} NearmissInput;

// A list in the device's memory.
typedef struct {
    // Where the first entry lies.
    uint64_t address;
    // How many entries there is room for.
    uint64_t room;
} NearmissDeviceList;

// Where the answer of a submitted frame lies in the device's memory, until the detector is asked anything else.
typedef struct {
    // What the entries are.
    NearmissEntries entries;
    // How many lists there are, 0 to 2. Of features one, in which those of vertices and faces come first, if they are in order; else one
    // of those and one of edges.
    uint32_t list_count;
    // They.
    NearmissDeviceList lists[2];
    // Whether entries are in canonical order.
    bool is_ordered;
    // Whether `earliest` is an address: of an earliest query.
    bool has_earliest;
    // Where the `NearmissFrameStatus` lies.
    uint64_t status;
    // Where the earliest time lies: a double, all bits set where nothing meets. The next 8 bytes
    // are twice those bits, plus 1 if the time is that of an undecided pair and of no contact.
    uint64_t earliest;
    // The two vertices of every edge, 8 bytes each; none of a discrete query.
    NearmissDeviceList edges;
    // In memory of the host, until the next call with the detector: the first vertex, triangle and edge of each body, and at the end how
    // many there are in all.
    const uint32_t (*starts)[3];
    // How many of them: one more than bodies.
    size_t start_count;
} NearmissDeviceAnswer;

// Two triangles, as they lie on the device.
typedef struct {
    // The first of the two.
    uint32_t a;
    // The second.
    uint32_t b;
} NearmissDevicePair;

// Two features that meet, as they lie on the device.
typedef struct {
    // The vertex, or the first edge.
    uint32_t a;
    // The face, or the second edge.
    uint32_t b;
    // No contact before.
    double toi;
    // The first contact is not after; the end of the step, where there need be none.
    double toi_upper;
    // 1 contact, 2 undecided; and 4 where the budget ended.
    uint32_t state;
    // Boxes looked at.
    uint32_t boxes;
} NearmissDeviceHit;

// Two features within a distance, as they lie on the device.
typedef struct {
    // The vertex, or the first edge.
    uint32_t a;
    // The face, or the second edge.
    uint32_t b;
    // Their squared distance.
    double squared;
    // Where they are nearest: the weights of the face's corners 1 and 2; or how far along both edges.
    double at[2];
} NearmissDeviceNearHit;

// The two nearest triangles, as they lie on the device.
typedef struct {
    // The triangle of the smaller index.
    uint32_t a;
    // The other.
    uint32_t b;
    // How far they are apart: 0 only if they share a point.
    double distance;
    // Of each the weights of corners 1 and 2.
    double at[2][2];
    // The nearest points.
    double points[2][3];
} NearmissDeviceNearest;

// What a submitted frame came to, as it lies on the device.
typedef struct {
    // Entries of the first list; of an earliest query 0.
    uint64_t first;
    // Entries of the second list. Where one list has both kinds in order, how many of the second kind follow.
    uint64_t second;
    // How many lists had too little room. Unless this is 0 no part of the answer may be used.
    uint64_t short_of_room;
    // Not 0 where positions or poses of the caller cannot be computed with: then there is no answer.
    uint64_t invalid;
    // Triangle pairs that share a point at the start of the step; all bits set if the start is not
    // checked. Part of the answer: usable only if `short_of_room` and `invalid` are 0.
    uint64_t crossing;
} NearmissFrameStatus;

#ifdef __cplusplus
extern "C" {
#endif // __cplusplus

// The version of the header that this library was built with. This and `nearmiss_version()` are the same in all versions.
uint32_t nearmiss_abi(void);

// The version of nearmiss, such as "0.1.0". It lives as long as the program.
const char *nearmiss_version(void);

// The triangle pairs of a discrete query, ascending by the first triangle and its body, then by the second. The list lives as long as the
// answer.
NearmissCode nearmiss_answer_triangle_pairs(const NearmissAnswer *answer,
                                            const NearmissTrianglePair **items,
                                            size_t *count,
                                            NearmissError *error);

// The contacts of a continuous query, ascending by kind, then by the first feature and its body, then by the second. The list lives as long
// as the answer.
NearmissCode nearmiss_answer_contacts(const NearmissAnswer *answer,
                                      const NearmissContact **items,
                                      size_t *count,
                                      NearmissError *error);

// The feature pairs of a near query, in the order of contacts. The list lives as long as the answer.
NearmissCode nearmiss_answer_near_pairs(const NearmissAnswer *answer,
                                        const NearmissNearPair **items,
                                        size_t *count,
                                        NearmissError *error);

// The nearest triangles of a distance query. `is_any` is false, and nothing else written, where no two bodies may meet.
NearmissCode nearmiss_answer_nearest(const NearmissAnswer *answer,
                                     bool *is_any,
                                     NearmissNearest *nearest,
                                     NearmissError *error);

// The smallest time of contact of an earliest or a continuous query, in [0, 1]: no contact is before it. `is_any` is false, and the time 1,
// if nothing meets. Triangles that cross at the start need not meet again:
// `nearmiss_answer_is_free` says whether the step is free.
NearmissCode nearmiss_answer_earliest(const NearmissAnswer *answer,
                                      bool *is_any,
                                      double *toi,
                                      NearmissError *error);

// Whether the answer proves that nothing touches. Continuous and earliest: the start was checked,
// no triangles share a point there, and nothing meets within the step. Discrete: no pair of
// triangles shares a point. Distance: it is above 0, or no two bodies may meet. Near: always
// false.
NearmissCode nearmiss_answer_is_free(const NearmissAnswer *answer,
                                     bool *is_free,
                                     NearmissError *error);

// Figures: how much was found, of how many candidates, and how long it took. Cost: a pass over the answer, for its hash.
NearmissCode nearmiss_answer_summary(const NearmissAnswer *answer,
                                     NearmissSummary *summary,
                                     NearmissError *error);

// In what the frame came to less than all that was asked: a sentence each, by its index. Nothing is ever missed for any of them. The text
// lives as long as the answer.
NearmissCode nearmiss_answer_degraded(const NearmissAnswer *answer,
                                      size_t index,
                                      const char **sentence,
                                      NearmissError *error);

// Makes the notes beside an answer, as the command line prints them, and counts them; mostly there
// are none. `nearmiss_answer_note` returns each. The bodies must be where they were at the frame.
// Cost: a comparison of both ends of the step if nothing moves; a sort of all vertices if there
// are 1,000 contacts.
NearmissCode nearmiss_detector_notes(NearmissDetector *detector,
                                     NearmissAnswer *answer,
                                     size_t *count,
                                     NearmissError *error);

// A note that `nearmiss_detector_notes` made, by its index. The text lives until they are made
// again, and no longer than the answer.
NearmissCode nearmiss_answer_note(const NearmissAnswer *answer,
                                  size_t index,
                                  const char **note,
                                  NearmissError *error);

// Vertices, weights, points and normal of every contact, or of every pair within a distance, in their order. The bodies must be where they were
// at the frame. The list lives until this is asked of the answer again. Cost: a copy of all vertices from the device, and a wait; 300 operations a contact.
NearmissCode nearmiss_detector_geometry(NearmissDetector *detector,
                                        NearmissAnswer *answer,
                                        const NearmissGeometry **items,
                                        size_t *count,
                                        NearmissError *error);

// Frees the answer, with all that it showed.
void nearmiss_answer_free(NearmissAnswer *answer);

// A deformable body without a mesh, in environment 0, that meets all others and itself.
NearmissBody nearmiss_body(void);

// Takes a copy of a scene, to which nothing can be added from then on, to a device and builds its
// trees. Cost: linear in triangles; memory grows with what is found.
//
// A scene without bodies answers nothing. Fails with `NEARMISS_INVALID_ARGUMENT` for choices that do not go
// together; with `NEARMISS_OUT_OF_MEMORY` and `NEARMISS_DEVICE`.
//
// # Safety
// The names of the query are texts or NULL.
NearmissCode nearmiss_detector_new(const NearmissDevice *device,
                                   const NearmissScene *scene,
                                   const NearmissQuery *query,
                                   NearmissDetector **detector,
                                   NearmissError *error);

// The tolerance of a certified solver, a length: as asked, or the smallest default of a pair of
// bodies, which is the smaller of theirs; -1 of other solvers.
NearmissCode nearmiss_detector_tolerance(NearmissDetector *detector,
                                         double *tolerance,
                                         NearmissError *error);

// The largest tolerance of a pair of bodies, a length: that of `nearmiss_detector_tolerance` if
// all pairs have the same; -1 of other solvers.
NearmissCode nearmiss_detector_largest_tolerance(NearmissDetector *detector,
                                                 double *tolerance,
                                                 NearmissError *error);

// Makes tiles or trees over what moves anew: pays when bodies have moved far from where these were made.
NearmissCode nearmiss_detector_rebuild(NearmissDetector *detector,
                                       NearmissError *error);

// Adds a body, from the next frame on, and tells its number: that of one that was removed, where there is one. `id` may be NULL. Cost: as of
// making the detector, at the next frame.
//
// # Safety
// What the body points to is there.
NearmissCode nearmiss_detector_add(NearmissDetector *detector,
                                   const NearmissBody *body,
                                   uint32_t *id,
                                   NearmissError *error);

// Puts another body, of any mesh, in the place of one, from the next frame on. Cost: as of making the detector, at the next frame.
//
// # Safety
// What the body points to is there.
NearmissCode nearmiss_detector_replace(NearmissDetector *detector,
                                       uint32_t id,
                                       const NearmissBody *new_,
                                       NearmissError *error);

// Takes a body out, from the next frame on; others keep their numbers. Cost: as of making the detector, at the next frame.
NearmissCode nearmiss_detector_remove(NearmissDetector *detector,
                                      uint32_t id,
                                      NearmissError *error);

// Frees the detector; waits for what it has submitted. Its answers stay.
void nearmiss_detector_free(NearmissDetector *detector);

// Opens a machine: a `NearmissBackend`, on a CPU with so many threads, at most as many as there are processors; 0 for all. Cost: of a GPU
// some 0.1 s for its context; its kernels are compiled by the driver when first used.
//
// Fails with `NEARMISS_DEVICE` when there is no such machine or its driver refuses, and with
// `NEARMISS_INVALID_ARGUMENT` for threads of `NEARMISS_CUDA`. With `NEARMISS_AUTO` the threads are those of
// the CPU that is taken if there is no GPU.
NearmissCode nearmiss_device_open(uint32_t backend,
                                  size_t threads,
                                  NearmissDevice **device,
                                  NearmissError *error);

// Opens the GPU with that number, as the driver counts them, in its primary context, which CUDA's runtime has too.
NearmissCode nearmiss_device_gpu(uint32_t ordinal,
                                 NearmissDevice **device,
                                 NearmissError *error);

// A GPU by a context and a stream of the caller: all work goes to that stream, behind what is there. `context` is a `CUcontext`, NULL for
// the one that the thread is bound to; `stream` a `CUstream` or `cudaStream_t`, NULL for the default one, which cannot be captured.
//
// # Safety
// The stream is of that context, and both outlive the device and all detectors made with it.
NearmissCode nearmiss_device_from_stream(void *context,
                                    void *stream,
                                    NearmissDevice **device,
                                    NearmissError *error);

// What the machine calls itself; the text lives as long as the device.
NearmissCode nearmiss_device_name(const NearmissDevice *device,
                                  const char **name,
                                  NearmissError *error);

// Whether it is a GPU.
NearmissCode nearmiss_device_is_gpu(const NearmissDevice *device,
                                    bool *is_gpu,
                                    NearmissError *error);

// Lets the machine use no more than that many bytes of its memory, from now on, for all of its detectors together.
NearmissCode nearmiss_device_limit(const NearmissDevice *device,
                                   uint64_t bytes,
                                   NearmissError *error);

// Frees the handle. The machine goes when its last detector does.
void nearmiss_device_free(NearmissDevice *device);

// The exit status that the command line has for a code: 0 done, 2 bad arguments, 3 bad input, 130
// interrupted, 4 all else.
uint32_t nearmiss_exit_code(uint32_t code);

// Moves bodies to where the inputs say, and answers. A body that is not named rests where it was, or where its step ended. Cost: one
// submission whatever the number of bodies, and a copy of what the host has.
//
// Fails with `NEARMISS_INVALID_ARGUMENT` for a body that is not there, or named twice, or given what its kind does not take; with `NEARMISS_INPUT` for
// positions that no mesh may have: then nothing has moved. There is no partial answer.
//
// # Safety
// So many inputs are there, and what they point to.
NearmissCode nearmiss_detector_frame(NearmissDetector *detector,
                                     const NearmissInput *inputs,
                                     size_t count,
                                     NearmissAnswer **answer,
                                     NearmissError *error);

// Moves bodies as `nearmiss_detector_frame` does, without a query.
//
// # Safety
// So many inputs are there, and what they point to.
NearmissCode nearmiss_detector_place(NearmissDetector *detector,
                                     const NearmissInput *inputs,
                                     size_t count,
                                     NearmissError *error);

// Answers with the bodies where they are.
NearmissCode nearmiss_detector_detect(NearmissDetector *detector,
                                      NearmissAnswer **answer,
                                      NearmissError *error);

// A deformable body stands there. For memory of the device set `on_device` then.
NearmissInput nearmiss_at(uint32_t body, NearmissRows positions);

// A deformable body moves from here to there. For memory of the device set `on_device` then.
NearmissInput nearmiss_step(uint32_t body, NearmissRows from, NearmissRows to);

// A rigid body stands in that pose.
NearmissInput nearmiss_pose(uint32_t body, NearmissPose pose);

// A rigid body moves from one pose to another.
NearmissInput nearmiss_poses(uint32_t body, NearmissPose from, NearmissPose to);

// Makes a handle that ends nothing yet. Give it to `nearmiss_device_interruptible`.
NearmissCode nearmiss_interrupt_new(NearmissInterrupt **interrupt, NearmissError *error);

// A handle that ends the calls of a detector. Free it; the detector may go before it.
NearmissCode nearmiss_detector_interrupter(const NearmissDetector *detector,
                                           NearmissInterrupt **interrupt,
                                           NearmissError *error);

// Another handle of the same machine. The interrupt ends the calls of detectors that are made with
// it, and their making. Free it as any device.
NearmissCode nearmiss_device_interruptible(const NearmissDevice *device,
                                           const NearmissInterrupt *interrupt,
                                           NearmissDevice **made,
                                           NearmissError *error);

// Ends the call that runs or, if none runs, the next one: it returns `NEARMISS_INTERRUPTED`,
// without an answer, and the detector can be used again. Bodies that the call named are where it
// said. One atomic store: safe in a signal handler. NULL does nothing.
void nearmiss_interrupt(const NearmissInterrupt *interrupt);

// Takes back an interrupt that has ended no call yet. As safe as `nearmiss_interrupt`.
void nearmiss_interrupt_clear(const NearmissInterrupt *interrupt);

// Frees a handle. Devices and detectors that it ends stay.
void nearmiss_interrupt_free(NearmissInterrupt *interrupt);

// Where the answer of what is submitted will lie, for kernels of the caller behind it. Fails with `NEARMISS_INVALID_ARGUMENT` where the detector is
// not prepared, or no two of its bodies can meet.
NearmissCode nearmiss_detector_on_device(NearmissDetector *detector,
                                         NearmissDeviceAnswer *answer,
                                         NearmissError *error);

// The plan of the last frame that was waited for, as a text of JSON: launches (`build`, `frame`), memory by what it is for (`buffers`), bytes that
// went to the device and came back (`transfers`), and what the scene does not need (`left_out`). All are the device's own counts. The text
// lives until this is asked of the detector again. A detector that was asked fewer than two frames asks what is missing.
NearmissCode nearmiss_detector_plan(NearmissDetector *detector,
                                    const char **json,
                                    NearmissError *error);

// A query of that kind with all choices at their defaults; of what is near the distance is still to be said.
NearmissQuery nearmiss_query(uint32_t kind);

// `count` points of three floats, without gaps.
NearmissRows nearmiss_floats(const float *points, size_t count);

// `count` points of three doubles, without gaps.
NearmissRows nearmiss_doubles(const double *points, size_t count);

// A scene without bodies.
NearmissCode nearmiss_scene_new(NearmissScene **scene, NearmissError *error);

// Adds a body and tells its number: they are counted from 0. `id` may be NULL. Cost: a copy of the mesh, and a pass over it.
//
// Fails with `NEARMISS_INPUT` for positions that are not finite or too large, and for indices out of range, naming the first; with
// `NEARMISS_INVALID_ARGUMENT` for a body that cannot be, and for a scene of which a detector has a copy.
// Then nothing is added.
//
// # Safety
// What the body points to is there.
NearmissCode nearmiss_scene_add(NearmissScene *scene,
                                const NearmissBody *body,
                                uint32_t *id,
                                NearmissError *error);

// Frees the scene. Detectors have their own.
void nearmiss_scene_free(NearmissScene *scene);

// Prepares frames that the host does not wait for: says where on the device bodies will be found (`on_device` of each input is 1), answers
// the frame that is there now, and takes all memory. Then `nearmiss_detector_submit` takes no memory and waits for nothing. Bodies that are
// not named rest. Any other call that changes the detector ends it.
//
// # Safety
// So many inputs are there; what they point to stays, and is written between frames alone, until another input or the end of the detector.
NearmissCode nearmiss_detector_prepare(NearmissDetector *detector,
                                       const NearmissInput *inputs,
                                       size_t count,
                                       NearmissAnswer **answer,
                                       NearmissError *error);

// Whether frames may be submitted, and what was recorded of one run again: it was prepared, and nothing has changed since.
NearmissCode nearmiss_detector_is_prepared(NearmissDetector *detector,
                                           bool *is_prepared,
                                           NearmissError *error);

// Submits a frame to the device's stream, with bodies where their memory says when its turn comes: launches alone, so it may be called while
// that stream is captured, and the graph launched as often as wanted. On a CPU it is done when this returns.
NearmissCode nearmiss_detector_submit(NearmissDetector *detector,
                                      NearmissError *error);

// Waits for what was submitted last, or recorded and launched again, and brings the answer. Where a list had too little room it grows and the
// frame is asked again: the answer is whole, and the detector no longer prepared.
NearmissCode nearmiss_detector_collect(NearmissDetector *detector,
                                       NearmissAnswer **answer,
                                       NearmissError *error);

#ifdef __cplusplus
}  // extern "C"
#endif  // __cplusplus

#endif  /* NEARMISS_H */
