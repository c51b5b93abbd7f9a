// nearmiss: exact collision detection for deforming triangle meshes, on CPUs and NVIDIA GPUs. Both
// return the same bits. For C99 and C++11.
//
// Made by cbindgen from c/src; see c/tests/header.rs.
//
// A program in six calls:
//
//     nearmiss_device_open(NEARMISS_AUTO, 0, &device, &error);
//     nearmiss_scene_create(&scene, &error);
//     nearmiss_scene_add(scene, &body, &id, &error);
//     nearmiss_detector_create(device, scene, &detector, &error);
//     nearmiss_detector_update(detector, motions, motion_count, &error);
//     nearmiss_detector_query(detector, &query, &answer, &error);
//
// Handles
// - `NearmissDevice` is a machine, `NearmissScene` holds bodies, `NearmissDetector` is a scene on a
//   device, `NearmissAnswer` is the answer to a query. A detector answers queries of all kinds.
// - A call that fills a `NearmissX **` makes a handle. `nearmiss_..._free` frees it; NULL is fine.
// - Handles may be freed in any order: detectors keep the machine and a copy of the scene.
// - A pointer into a handle lives as long as the handle, unless its function says otherwise.
//
// Errors
// - A call returns a `NearmissCode`, 0 for success. A `NearmissError` gets the message.
//   NULL for it is fine. After an error a handle that was to be made is NULL, and other results are
//   not written.
// - A NULL pointer returns `NEARMISS_INVALID_ARGUMENT`, unless its function gives it a meaning.
// - A fault of the library returns `NEARMISS_BUG`. The detector then refuses all further calls.
//
// Numbers
// - Positions are floats or doubles in any unit, up to 2^480 in size. Vertices of triangles must be
//   finite. Lengths are in that unit. Times are parts of a step, from 0 to 1. Indices count from 0.
// - Begin structs by `nearmiss_body()`, `nearmiss_query()` and `nearmiss_motion_...()`, then set
//   fields. Never fill them by hand: a new version may add fields.
//
// Threads
// - Use a handle from one thread at a time. All detectors of a device count as one handle.
//   `nearmiss_device_name`, `_is_gpu`, `_set_memory_limit` and `_free` may run at the same time. An
//   answer is a handle by itself.
// - Any thread and any signal handler may call `nearmiss_interrupt` and `nearmiss_interrupt_clear`.
// - The first CPU or detector starts one thread a processor. They stay. A process that was forked
//   later has none of them, and calls that need them return `NEARMISS_INVALID_ARGUMENT`. Start
//   processes by `posix_spawn` or `exec`, or fork before.


#ifndef NEARMISS_H
#define NEARMISS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

// The version of this header. It changes whenever a struct or a function changes. Compare it with
// `nearmiss_abi()` before any other call: a library of another version has other structs.
#define NEARMISS_ABI 8

// Bytes of an error's text.
#define NEARMISS_TEXT 1016

// Codes of a call's end, one for each kind of error.
enum NearmissCode
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : uint32_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
    // Success.
    NEARMISS_OK = 0,
    // An argument that no data could make valid: an option, a name, a kind, the number of a
    // body, a pointer. Correct the call.
    NEARMISS_INVALID_ARGUMENT = 1,
    // Data that cannot be used: numbers of a mesh, of positions or of a pose. Correct the data.
    NEARMISS_INPUT = 2,
    // A result could not be written.
    NEARMISS_OUTPUT = 3,
    // The machine or its driver failed. The message quotes it.
    NEARMISS_DEVICE = 4,
    // A measurement is worse than an earlier one.
    NEARMISS_REGRESSION = 5,
    // Not enough memory. There is no answer.
    NEARMISS_OUT_OF_MEMORY = 6,
    // The GPU's kernels were made from other sources than the library. Build it again.
    NEARMISS_KERNEL_MISMATCH = 7,
    // A fault of nearmiss itself. Please report it.
    NEARMISS_BUG = 8,
    // A `NearmissInterrupt` ended the call. There is no answer; the detector can be used again.
    NEARMISS_INTERRUPTED = 9,
};
#ifndef __cplusplus
#if __STDC_VERSION__ >= 202311L
typedef enum NearmissCode NearmissCode;
#else
typedef uint32_t NearmissCode;
#endif // __STDC_VERSION__ >= 202311L
#endif // __cplusplus

// Kinds of feature pairs.
enum NearmissKind
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : uint32_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
    // Feature a is a vertex, feature b a face.
    NEARMISS_VF = 0,
    // Both features are edges. Numbers ascend by (larger vertex, smaller vertex), or are as given.
    NEARMISS_EE = 1,
    // Feature a is an edge of no triangle, feature b a vertex.
    NEARMISS_EV = 2,
    // Both features are vertices, one of them a point: of no triangle and no edge.
    NEARMISS_VV = 3,
};
#ifndef __cplusplus
#if __STDC_VERSION__ >= 202311L
typedef enum NearmissKind NearmissKind;
#else
typedef uint32_t NearmissKind;
#endif // __STDC_VERSION__ >= 202311L
#endif // __cplusplus

// Certainty of a contact.
enum NearmissStatus
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : uint32_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
    // Reported by a solver without a proof.
    NEARMISS_STATUS_UNVERIFIED = 0,
    // Proven: the pair collides, first within `[toi, toi_upper]`.
    NEARMISS_STATUS_CERTIFIED = 1,
    // The pair comes nearer than the tolerance, or `max_iterations` ended. Proven: if it collides,
    // not before `toi`.
    NEARMISS_STATUS_UNDECIDED = 2,
};
#ifndef __cplusplus
#if __STDC_VERSION__ >= 202311L
typedef enum NearmissStatus NearmissStatus;
#else
typedef uint32_t NearmissStatus;
#endif // __STDC_VERSION__ >= 202311L
#endif // __cplusplus

// The parts of two features that are nearest.
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

// How two triangles meet. The inside of a triangle is the triangle without its edges.
enum NearmissPairKind
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : uint32_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
    // They cross: their insides share a point, and no plane holds both.
    NEARMISS_CROSSING = 0,
    // They touch in one point.
    NEARMISS_TOUCH_POINT = 1,
    // They touch in a segment: an edge is on a face or along an edge.
    NEARMISS_TOUCH_SEGMENT = 2,
    // They overlap in one plane, in an area.
    NEARMISS_OVERLAP = 3,
};
#ifndef __cplusplus
#if __STDC_VERSION__ >= 202311L
typedef enum NearmissPairKind NearmissPairKind;
#else
typedef uint32_t NearmissPairKind;
#endif // __STDC_VERSION__ >= 202311L
#endif // __cplusplus

// Types of entries of a list on the device. Vertices, triangles and edges are numbered through all
// bodies.
enum NearmissEntries
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : uint32_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
    // `NearmissDevicePair`: two triangles.
    NEARMISS_TRIANGLE_PAIRS = 0,
    // `NearmissDeviceHit`: a vertex and a triangle, or two edges, and their times of contact. An
    // earliest query has none, or on request those at its time: `NearmissDeviceExtras`.
    NEARMISS_CONTACTS = 1,
    // `NearmissDeviceNearHit`: a vertex and a triangle, or two edges, and their nearest points.
    NEARMISS_NEAR_PAIRS = 2,
    // `NearmissDeviceNearest`: two triangles, their distance and nearest points.
    NEARMISS_NEAREST = 3,
    // `NearmissDevicePair`: two bodies that share a point, by their places in the scene. In no
    // order.
    NEARMISS_PAIRS_OF_BODIES = 4,
};
#ifndef __cplusplus
#if __STDC_VERSION__ >= 202311L
typedef enum NearmissEntries NearmissEntries;
#else
typedef uint32_t NearmissEntries;
#endif // __STDC_VERSION__ >= 202311L
#endif // __cplusplus

// Machines to choose from.
enum NearmissBackend
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : uint32_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
    // The CPU.
    NEARMISS_CPU = 0,
    // The first NVIDIA GPU.
    NEARMISS_CUDA = 1,
    // The first NVIDIA GPU, or the CPU if there is none.
    NEARMISS_AUTO = 2,
};
#ifndef __cplusplus
#if __STDC_VERSION__ >= 202311L
typedef enum NearmissBackend NearmissBackend;
#else
typedef uint32_t NearmissBackend;
#endif // __STDC_VERSION__ >= 202311L
#endif // __cplusplus

// Types of numbers.
enum NearmissNumber
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : uint32_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
    // Single precision.
    NEARMISS_F32 = 0,
    // Double precision, never rounded to single.
    NEARMISS_F64 = 1,
};
#ifndef __cplusplus
#if __STDC_VERSION__ >= 202311L
typedef enum NearmissNumber NearmissNumber;
#else
typedef uint32_t NearmissNumber;
#endif // __STDC_VERSION__ >= 202311L
#endif // __cplusplus

// Kinds of bodies.
enum NearmissBodyKind
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : uint32_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
    // It never moves. It is built once, costs nothing in later steps, and is not tested against
    // other fixed bodies.
    NEARMISS_BODY_FIXED = 0,
    // It moves by poses.
    NEARMISS_BODY_RIGID = 1,
    // Each vertex moves by itself.
    NEARMISS_BODY_DEFORMABLE = 2,
};
#ifndef __cplusplus
#if __STDC_VERSION__ >= 202311L
typedef enum NearmissBodyKind NearmissBodyKind;
#else
typedef uint32_t NearmissBodyKind;
#endif // __STDC_VERSION__ >= 202311L
#endif // __cplusplus

// Whether a body is tested against itself.
enum NearmissSelfCollision
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : uint32_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
    // Deformable bodies are, rigid and fixed bodies are not. A struct of zeros has this.
    NEARMISS_SELF_COLLISION_DEFAULT = 0,
    // It is. Refused for fixed bodies.
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

// Kinds of motions.
enum NearmissMotionKind
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : uint32_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
    // A deformable body rests at `positions[0]`.
    NEARMISS_MOTION_POSITIONS = 0,
    // A deformable body moves from `positions[0]` to `positions[1]`, each vertex in a straight
    // line. Discrete, near and distance queries test it at `positions[0]`. It rests at
    // `positions[1]` if the next update does not name it.
    NEARMISS_MOTION_STEP = 1,
    // A rigid body rests in `poses[0]`.
    NEARMISS_MOTION_POSE = 2,
    // A rigid body moves from `poses[0]` to `poses[1]`. It turns at a constant rate by the shorter
    // arc, about `pivot`, which moves in a straight line. At exactly 180 degrees the axis is that
    // with a positive first coordinate; if this is 0, a positive second or third one. If `straight`
    // is 1, each vertex moves in a straight line, and the body is not rigid on the way.
    NEARMISS_MOTION_POSE_STEP = 3,
    // A rigid body moves from `poses[0]`. It turns at a constant rate by the rotation vector `turn`
    // about `pivot`, which moves by `travel` in a straight line.
    NEARMISS_MOTION_TURNING = 4,
};
#ifndef __cplusplus
#if __STDC_VERSION__ >= 202311L
typedef enum NearmissMotionKind NearmissMotionKind;
#else
typedef uint32_t NearmissMotionKind;
#endif // __STDC_VERSION__ >= 202311L
#endif // __cplusplus

// Kinds of queries.
enum NearmissQueryKind
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : uint32_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
    // Pairs of triangles that share a point, at the start of the step. Read them by
    // `nearmiss_answer_triangle_pairs`.
    NEARMISS_DISCRETE = 0,
    // Pairs of features that collide within the step, with their times. Read them by
    // `nearmiss_answer_contacts`.
    NEARMISS_CONTINUOUS = 1,
    // Time of the first contact of the step. Read it by `nearmiss_answer_earliest`.
    NEARMISS_EARLIEST = 2,
    // Pairs of features within a distance, at the start of the step. Set `distance`. Read them by
    // `nearmiss_answer_near_pairs`.
    NEARMISS_NEAR = 3,
    // Distance of the two nearest bodies, at the start of the step. Read it by
    // `nearmiss_answer_nearest`.
    NEARMISS_DISTANCE = 4,
    // Pairs of bodies that share a point, at the start of the step. Read them by
    // `nearmiss_answer_body_pairs`.
    NEARMISS_BODY_PAIRS = 5,
    // Least distance of each two bodies, at the start of the step. Set `distance`. Read them by
    // `nearmiss_answer_body_distances`.
    NEARMISS_BODY_DISTANCES = 6,
};
#ifndef __cplusplus
#if __STDC_VERSION__ >= 202311L
typedef enum NearmissQueryKind NearmissQueryKind;
#else
typedef uint32_t NearmissQueryKind;
#endif // __STDC_VERSION__ >= 202311L
#endif // __cplusplus

// When a detector rebuilds its tiles. No answer depends on it.
enum NearmissRebuild
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : uint32_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
    // When queries have become slower by as much as rebuilding costs; also by
    // `nearmiss_detector_rebuild`.
    NEARMISS_REBUILD_AUTO = 0,
    // Only by `nearmiss_detector_rebuild`.
    NEARMISS_REBUILD_MANUAL = 1,
};
#ifndef __cplusplus
#if __STDC_VERSION__ >= 202311L
typedef enum NearmissRebuild NearmissRebuild;
#else
typedef uint32_t NearmissRebuild;
#endif // __STDC_VERSION__ >= 202311L
#endif // __cplusplus

// Features of a body by which rows are grouped.
enum NearmissGroupBy
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : uint32_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
    // Vertices: of vertex/face and edge/vertex rows, and both of two points.
    NEARMISS_BY_VERTEX = 0,
    // Edges: both of edge/edge rows, and those of edge/vertex rows.
    NEARMISS_BY_EDGE = 1,
    // Triangles, then edges of none, then points: faces of vertex/face rows, and both of a
    // triangle pair.
    NEARMISS_BY_FACE = 2,
    // All vertices that take part in a row: four of a row of features, six of a triangle pair.
    NEARMISS_BY_CORNER = 3,
};
#ifndef __cplusplus
#if __STDC_VERSION__ >= 202311L
typedef enum NearmissGroupBy NearmissGroupBy;
#else
typedef uint32_t NearmissGroupBy;
#endif // __STDC_VERSION__ >= 202311L
#endif // __cplusplus

// The answer to a query. It never changes, and needs neither detector nor device.
typedef struct NearmissAnswer NearmissAnswer;

// A scene on a device. It answers queries of all kinds, step after step, from one memory.
typedef struct NearmissDetector NearmissDetector;

// A machine that runs kernels, and its memory.
typedef struct NearmissDevice NearmissDevice;

// A handle that ends calls early. Any thread may use it, until it is freed.
typedef struct NearmissInterrupt NearmissInterrupt;

// Bodies, by their numbers.
typedef struct NearmissScene NearmissScene;

// Two triangles that share a point.
typedef struct {
    // Their bodies, the smaller number first.
    uint32_t bodies[2];
    // Their indices in these bodies. Within a body the smaller is first.
    uint32_t triangles[2];
} NearmissTrianglePair;

// The error of a call, in memory of the caller. It need not be initialised; a call that succeeds
// clears it.
typedef struct {
    // The code that the call returned.
    NearmissCode code;
    // Bytes of the whole text without the final zero, also if it was cut.
    uint32_t length;
    // One sentence with the problem and the remedy, in UTF-8, with a zero at its end. It is cut if
    // it is too long.
    char text[NEARMISS_TEXT];
} NearmissError;

// Two features that collide within the step: they touch, or come within `min_separation`.
typedef struct {
    // The kind of both features.
    NearmissKind kind;
    // Certainty.
    NearmissStatus status;
    // The bodies of feature a and of feature b.
    uint32_t bodies[2];
    // Index of the first feature of the kind in its body.
    uint32_t feature_a;
    // Index of the second feature in its body.
    uint32_t feature_b;
    // Time of contact, in [0, 1] of the step. Certified: never later than the first contact.
    double toi;
    // Upper bound of the first contact, in [toi, 1]. Undecided: 1.
    double toi_upper;
} NearmissContact;

// Two features within a distance of each other, and their nearest points.
typedef struct {
    // The kind of both features.
    NearmissKind kind;
    // The nearest parts of the two.
    NearmissClosest closest;
    // The bodies of feature a and of feature b.
    uint32_t bodies[2];
    // Index of the first feature of the kind in its body.
    uint32_t feature_a;
    // Index of the second feature in its body.
    uint32_t feature_b;
    // Squared distance. Its root errs by at most 192 half ulps of the extent of the features. A
    // square below 2^-1022 has fewer digits; one below 2^-1075 is 0, though the features may be
    // apart.
    double squared_distance;
    // Weights of the four vertices in the nearest points. Vertex/face: the vertex (1), then the
    // face's corners. Edge/edge: both ends of edge a, then both ends of edge b, the larger index
    // first. Those of a feature sum to 1.
    double weights[4];
} NearmissNearPair;

// The two nearest triangles of different bodies, and their nearest points.
typedef struct {
    // Their bodies, the smaller number first.
    uint32_t bodies[2];
    // Their indices in these bodies.
    uint32_t triangles[2];
    // Distance. 0 if and only if they share a point. Else it errs by at most 192 half ulps of the
    // larger extent: of these triangles, or of the truly nearest ones.
    double distance;
    // Weights of the corners of each triangle in its nearest point.
    double weights[2][3];
    // The nearest points.
    double points[2][3];
} NearmissNearest;

// Two bodies that share a point.
typedef struct {
    // The bodies, the smaller number first.
    uint32_t bodies[2];
} NearmissBodyPair;

// Rows of numbers, such as positions of three numbers a row. Gaps between rows are not read.
typedef struct {
    // The first number, aligned; of memory of a device its address there. NULL for no rows.
    const void *data;
    // Number of rows.
    size_t count;
    // Bytes from one row to the next: a multiple of the number's size, at least a row. 0 for rows
    // without gaps.
    size_t stride;
    // `NEARMISS_F32` or `NEARMISS_F64`.
    uint32_t number;
} NearmissRows;

// A rigid motion of the points of a body's mesh: a rotation, then a translation.
typedef struct {
    // A unit quaternion: x, y, z, w. Its length may differ from 1 by up to 1.19e-4; it is
    // normalised.
    double rotation[4];
    // Added after the rotation, in the unit of the positions.
    double translation[3];
} NearmissPose;

// A body to add to a scene: mesh, kind, and collision filter. Begin with `nearmiss_body()`. Calls
// copy everything that it points to.
typedef struct {
    // The name in messages, in UTF-8. NULL: "a body".
    const char *name;
    // One point a vertex, in memory of the host.
    NearmissRows positions;
    // Three indices of vertices a triangle, without gaps.
    const uint32_t *triangles;
    // Number of triangles. A body needs a triangle, an edge or a point.
    size_t triangle_count;
    // A `NearmissBodyKind`.
    uint32_t kind;
    // A `NearmissSelfCollision`.
    uint32_t self_collision;
    // Bodies of different environments do not collide.
    uint32_t environment;
    // 1: the body is in every environment, and `environment` must be 0. 0: only in `environment`.
    uint32_t everywhere;
    // Bits of the groups of the body, at least one. Two bodies collide if each is in a group of
    // the other's mask.
    uint32_t group;
    // Bits of the groups that it collides with. 0: it collides with no other body.
    uint32_t mask;
    // The pose of a rigid body at the start.
    NearmissPose pose;
    // Thickness: radii around the surface that belong to the body, lengths of at least 0. Near
    // queries and queries in motion add those of both bodies to their distance. All others ignore
    // them.
    const double *radii;
    // How many radii there are: 0 for none, 1 for all vertices, or one for each.
    size_t radius_count;
    // Two indices of vertices an edge, without gaps. Edges of no triangle take part by themselves.
    // They also number the edges of answers: those of triangles that are not listed come behind.
    const uint32_t *edges;
    // Number of edges.
    size_t edge_count;
    // Vertices of no triangle and no edge that take part by themselves.
    const uint32_t *points;
    // Number of points.
    size_t point_count;
} NearmissBody;

// Pairs of features of a body that are not tested against each other, and faces that take no
// part. A feature is a vertex, an edge or a face. Begin with `nearmiss_exclusions()`. Calls
// copy everything that it points to.
typedef struct {
    // The rest shape, a point a vertex, in memory of the host. NULL data: the place of the
    // body, at t = 0.
    NearmissRows rest;
    // Indices of faces that take no part, and with them vertices and edges of no other face.
    const uint32_t *faces;
    // Number of these.
    size_t face_count;
    // A length from 0. Pairs of features that are nearer than this in the rest shape are left
    // out. 0 leaves out none.
    double within;
    // A pair of features is left out if a vertex of one and a vertex of the other have at most
    // `ring - 1` edges between them. All queries leave out pairs of ring 1, except a discrete
    // one that keeps adjacent triangles. 0 for no ring.
    uint32_t ring;
    // Zero.
    uint32_t pad;
} NearmissExclusions;

// Parts of answers that submissions also make on the device. Begin by `nearmiss_device_extras()`.
//
// Answers to continuous and near queries have all parts. Those of discrete queries have groups by
// face and by corner. Those of earliest queries have the contacts at their time, and then all parts
// of these. Others have none.
typedef struct {
    // 1: a `NearmissDeviceRowGeometry` for each row. Cost: 128 bytes a row that there is room for.
    uint32_t geometry;
    // 1: the least time or distance of each vertex. Cost: 8 bytes a vertex.
    uint32_t least_by_vertex;
    // Features by which rows are grouped: each a `NearmissGroupBy`. NULL for none. Cost of each: a
    // sort, and 20 bytes for each feature of a row.
    const uint32_t *grouped_by;
    // How many there are.
    size_t group_count;
    // 1: the contacts at the time of an earliest query, in the lists of its answer, in no order.
    // The status counts them, and other parts are of these rows too.
    uint32_t first_contacts;
} NearmissDeviceExtras;

// The motion of a body in a step, or its place at rest. Make it by `nearmiss_motion_positions`,
// `_step`, `_pose`, `_pose_step` or `_turning`. Fields that `kind` does not read must be empty.
typedef struct {
    // The number of the body.
    uint32_t body;
    // A `NearmissMotionKind`.
    uint32_t kind;
    // 0: memory of the host, read by the call. 1: memory of the detector's device (on a CPU the
    // host's), read there, after all earlier work of its stream. It must stay until the query is
    // answered; of a prepared submission until the next update. A pose on the device is a row of
    // three numbers in `positions` and a row of four in `rotations`.
    uint32_t on_device;
    // 1: the vertices of a pose step go straight. 0: it turns. Poses on the device always turn.
    uint32_t straight;
    // One row a vertex. For a pose on the device: its translation.
    NearmissRows positions[2];
    // For a pose on the device: its unit quaternion x, y, z, w.
    NearmissRows rotations[2];
    // Poses in memory of the host.
    NearmissPose poses[2];
    // The point about which the step turns, in the frame of the mesh: a centre of mass, a hinge.
    // Zeros on the device: poses there turn about the origin of the mesh.
    double pivot[3];
    // The rotation vector of a turning step, in the axes of the scene and in radians: angular
    // velocity times the length of the step. At most a whole turn, 2 pi.
    double turn[3];
    // How far the pivot of a turning step moves.
    double travel[3];
} NearmissMotion;

// Choices for research. NULL is the default. Volumes, trees and tiles change no answer; a solver
// can.
typedef struct {
    // Discrete: "exact", "moller". Continuous, earliest: "certified", "certified-f64",
    // "certified-f32", "cubic-f64", "cubic-f32". "moller" and the cubics can miss collisions.
    const char *solver;
    // "aabb", "linear", "obb".
    const char *bounding_volume;
    // "tiles", "tree".
    const char *broad_phase;
    // Refit of trees: "levels", "treelets".
    const char *refit;
} NearmissResearch;

// A query and its numbers. Begin with `nearmiss_query()`, then set fields. A field that the kind
// of query does not have is refused if it is set. Numbers may change from call to call: nothing is
// rebuilt.
typedef struct {
    // A `NearmissQueryKind`.
    uint32_t kind;
    // Discrete. 1: also test triangles that share a vertex, beyond that vertex. 0: skip them.
    uint32_t adjacent;
    // Discrete. 1: leave out triangles that touch without crossing, see `NEARMISS_CROSSING`. 0:
    // list them too.
    uint32_t only_crossing;
    // Continuous, earliest. 1: take the start of the step to be free of crossing triangles. 0:
    // count them.
    uint32_t assume_free;
    // Continuous, earliest. 1: features within `min_separation` at the start collide from when
    // they come nearer than there. 0: they collide at the start.
    uint32_t approaching;
    // Continuous, earliest. Most iterations of the solver for a pair, before the pair is left
    // undecided. 0: the default.
    uint32_t max_iterations;
    // A `NearmissRebuild`.
    uint32_t rebuild;
    // Pairs of bodies. The first so many are listed; with 1 the work ends early. 0: all.
    uint32_t first;
    // Near: pairs up to this distance are listed, a length above 0. Distances of bodies: those up
    // to this one, a length of at least 0.
    double distance;
    // Continuous, earliest. Tolerance, a length: a time is early by at most what it takes to move
    // that far. -1: the default, 1e-4 of the mean edge.
    double tolerance;
    // Continuous, earliest. Minimum separation, a length: features that come this near collide.
    // 0: they touch.
    double min_separation;
    // Choices for research. Leave them as they are.
    NearmissResearch research;
} NearmissQuery;

// A list in memory of the device.
typedef struct {
    // Address of the first entry.
    uint64_t address;
    // Room, in entries.
    uint64_t room;
} NearmissDeviceList;

// Addresses of the parts of an answer, in memory of the device. A part that was not prepared has
// address 0. Rows are numbered through both lists, features through all bodies.
typedef struct {
    // A `NearmissDeviceRowGeometry` for each row.
    NearmissDeviceList geometry;
    // A double for each vertex: its least time or distance, infinity without a row.
    NearmissDeviceList least_by_vertex;
    // For each `NearmissGroupBy`: a uint32_t for each feature, and the end. The rows of feature i
    // are `rows[starts[i]]` to `rows[starts[i + 1] - 1]`, ascending.
    NearmissDeviceList starts[4];
    // For each `NearmissGroupBy`: numbers of rows, uint32_t. All bits of an unused one are set.
    NearmissDeviceList rows[4];
} NearmissExtrasOnDevice;

// Vertices, weights, points and normal of a contact, or of a near pair. The four vertices are
// those of feature a, then those of feature b. Vertex/face: the vertex, then the face's three
// corners. Edge/edge: both ends of edge a, then both ends of edge b, the larger index first.
typedef struct {
    // The body of each vertex.
    uint32_t owner[4];
    // The vertices, by their indices in their bodies.
    uint32_t vertices[4];
    // Weight of each vertex in the nearest point of its feature. Those of a feature sum to 1.
    double weights[4];
    // The same, negative for vertices of feature b: their weighted sum is the gap from b to a.
    double signed_weights[4];
    // The nearest points of both features, at the time of contact.
    double points[2][3];
    // Distance of these points.
    double distance;
    // Unit vector from feature b to feature a. Zeros if no direction is defined.
    double normal[3];
} NearmissGeometry;

// How the triangles of a row meet, by exact signs, and the ends of their common segment.
typedef struct {
    // How they meet.
    NearmissPairKind kind;
    // For each end, the part of each triangle that holds it. 0: the inside. 1 to 3: the edges from
    // corner 0, 1 and 2 to the next corner. 4 to 6: the corners. 255 for an overlap.
    uint8_t parts[2][2];
    // Both ends: the exact points, each coordinate rounded to the nearest double. Equal for a
    // point, NaN for an overlap. The segment of two planes runs along the first normal times the
    // second.
    double ends[2][3];
    // Upper bound of the error of each coordinate: 0 if both ends are corners, else half an ulp of
    // the largest coordinate.
    double error;
} NearmissPairGeometry;

// Rows by feature. The rows of feature i are `rows[starts[i]]` to `rows[starts[i + 1] - 1]`,
// ascending.
typedef struct {
    // Start of each feature's rows, and their end: one number more than features.
    const uint32_t *starts;
    // Indices of rows in the answer.
    const uint32_t *rows;
    // Number of features: of all vertices, edges or faces of the body.
    size_t feature_count;
    // Number of entries of `rows`.
    size_t row_count;
} NearmissGrouped;

// Curves in which surfaces cross. Curve k has the points `points[starts[k]]` to
// `points[starts[k + 1] - 1]`; a closed curve has its first point again at its end. Segments are
// one less than points, so those of curve k begin at `rows[starts[k] - k]`.
typedef struct {
    // Points of all curves, curve by curve, in scene units.
    const double (*points)[3];
    // First point of each curve, and the number of points: one number more than curves.
    const size_t *starts;
    // Whether each curve is closed.
    const bool *is_closed;
    // Row of each segment.
    const uint32_t *rows;
    // Group of each curve. Rows that share a triangle or an end are in one group.
    const uint32_t *groups;
    // Group of each row of the answer: UINT32_MAX for rows that do not cross.
    const uint32_t *row_groups;
    // Number of curves.
    size_t curve_count;
    // Number of rows of the answer.
    size_t row_count;
} NearmissCurves;

// Addresses of the answer to a submitted query, in memory of the device. They hold until the
// detector is no longer prepared.
typedef struct {
    // Type of the entries.
    NearmissEntries entries;
    // Number of lists, 0 to 2. Ordered feature pairs have one list: vertex/face rows, then
    // edge/edge rows. Others have a list of vertex/face rows and a list of edge/edge rows.
    uint32_t list_count;
    // The lists.
    NearmissDeviceList lists[2];
    // Whether entries are in canonical order.
    bool is_ordered;
    // Whether `earliest` is an address: of an earliest query.
    bool has_earliest;
    // Address of the `NearmissFrameStatus`.
    uint64_t status;
    // Address of the earliest time: a double, with all bits set if nothing collides. The next 8
    // bytes are twice those bits, plus 1 if the time is that of an undecided pair only.
    uint64_t earliest;
    // The two vertices of every edge, 8 bytes each; none of a discrete query.
    NearmissDeviceList edges;
    // The first vertex, triangle and edge of each body, and at the end the numbers of all. In
    // memory of the host, until the next preparation.
    const uint32_t (*starts)[3];
    // Length of `starts`: the number of bodies, and one more.
    size_t start_count;
} NearmissDeviceAnswer;

// Poses of many bodies, one row a body. Begin with `nearmiss_pose_rows()`.
typedef struct {
    // Translations, three numbers a row.
    NearmissRows positions;
    // Unit quaternions x, y, z, w, four numbers a row.
    NearmissRows quaternions;
    // 0: memory of the host. 1: memory of the detector's device; see `NearmissMotion`.
    uint32_t on_device;
} NearmissPoseRows;

// A device's share of a query's last frame.
typedef struct {
    // Its part of the tiles, 0 to 1.
    double tiles;
    // Milliseconds of the frame, by the device's own clock.
    double ms;
} NearmissShare;

// Milliseconds of each stage of a query, by the device's clock; `launch` and `wall` by the host's.
// For diagnosis: stages may change.
typedef struct {
    // Positions of bodies that have moved, with their upload.
    double place;
    // Tiles or trees, when they were built last.
    double construct;
    // Volumes of triangles.
    double fit;
    // All other volumes.
    double refit;
    // Candidates.
    double traverse;
    // Balancing of work queues, if that is a step of its own.
    double balance;
    // Tests of candidates.
    double narrow;
    // Sorting of rows, on a GPU.
    double order;
    // From positions to rows, without placing, construction and sorting.
    double total;
    // The host's work until a GPU had the query to do.
    double launch;
    // The whole call, without the copy into the answer.
    double wall;
} NearmissStages;

// Figures of an answer.
typedef struct {
    // Number of rows. For an earliest or a distance query: 1 or 0.
    uint64_t contacts;
    // Pairs of triangles whose volumes overlap.
    uint64_t triangle_pairs;
    // Pairs that were tested.
    uint64_t candidates;
    // Undecided pairs. For an earliest query: 1 if its time is that of an undecided pair, else 0.
    uint64_t undecided;
    // Number of reruns, because a list was too short. The answer is whole.
    uint64_t reruns;
    // Number of slices. More than 1 if memory was too small for the whole at once.
    uint64_t slices;
    // Peak of the device's memory in bytes, of all detectors of the device.
    uint64_t bytes;
    // Hash of the rows. Equal answers have equal hashes on every machine.
    uint64_t hash;
    // Pairs of triangles that share a point at the start of the step; 0 if it was not checked.
    uint64_t starts_crossing;
    // Whether the start of the step was checked: of a continuous or an earliest query, unless it
    // has `assume_free`.
    bool is_start_checked;
    // Number of caveats: see `nearmiss_answer_caveat`.
    uint64_t caveats;
    // Times.
    NearmissStages ms;
} NearmissSummary;

// Two triangles, or two bodies, in memory of the device.
typedef struct {
    // The triangles, or the bodies.
    uint32_t triangles[2];
} NearmissDevicePair;

// Two features that collide, in memory of the device.
typedef struct {
    // The vertex, or the first edge.
    uint32_t feature_a;
    // The face, or the second edge.
    uint32_t feature_b;
    // Time of contact, never late.
    double toi;
    // Upper bound of the first contact; undecided: 1.
    double toi_upper;
    // 1: contact. 2: undecided. 4 is added if `max_iterations` ended.
    uint32_t state;
    // Iterations of the solver.
    uint32_t iterations;
} NearmissDeviceHit;

// Two features within a distance, in memory of the device.
typedef struct {
    // The vertex, or the first edge.
    uint32_t feature_a;
    // The face, or the second edge.
    uint32_t feature_b;
    // Squared distance.
    double squared_distance;
    // Nearest points. Vertex/face: weights of the face's corners 1 and 2. Edge/edge: the place on
    // each edge, from 0 at its larger vertex index to 1.
    double at[2];
} NearmissDeviceNearHit;

// The two nearest triangles, in memory of the device.
typedef struct {
    // The triangles, the smaller index first.
    uint32_t triangles[2];
    // Distance; 0 only if they share a point.
    double distance;
    // Weights of corners 1 and 2 of each.
    double at[2][2];
    // The nearest points.
    double points[2][3];
} NearmissDeviceNearest;

// Geometry of a row, in memory of the device. Unused rows are zeros, so they weigh nothing.
typedef struct {
    // Distance of the nearest points.
    double distance;
    // Unit vector from the second feature towards the first; zeros if no direction is defined.
    double normal[3];
    // Weight of each vertex in the nearest point of its feature, negative for the second feature.
    double signed_weights[4];
    // Nearest points of both features at the time of contact.
    double points[2][3];
    // The vertices, numbered through all bodies: a vertex and the face's corners, or the ends of
    // two edges. With fewer, the last one is repeated.
    uint32_t vertices[4];
} NearmissDeviceRowGeometry;

// Counts of a submitted query, in memory of the device.
typedef struct {
    // Entries of the first list; of an earliest query 0, unless its contacts were prepared.
    uint64_t first;
    // Entries of the second list. In one ordered list: the number of edge/edge rows.
    uint64_t second;
    // Number of lists that were too short. Unless it is 0, no part of the answer may be used.
    uint64_t short_of_room;
    // Not 0 if positions or poses were invalid. Then there is no answer.
    uint64_t invalid;
    // Triangle pairs that share a point at the start of the step. All bits are set if it was not
    // checked. Part of the answer: usable only if `short_of_room` and `invalid` are 0.
    uint64_t crossing;
} NearmissFrameStatus;

#ifdef __cplusplus
extern "C" {
#endif // __cplusplus

// The version of the header that this library was built with. This function and
// `nearmiss_version()` are the same in all versions.
uint32_t nearmiss_abi(void);

// The version of nearmiss, such as "0.1.0". The text lives as long as the program.
const char *nearmiss_version(void);

// Triangle pairs of a discrete query, ascending by the first triangle and its body, then by the
// second. The list lives as long as the answer.
NearmissCode nearmiss_answer_triangle_pairs(const NearmissAnswer *answer,
                                            const NearmissTrianglePair **items,
                                            size_t *count,
                                            NearmissError *error);

// Contacts of a continuous query, in canonical order: the same on every machine. The list lives as
// long as the answer.
NearmissCode nearmiss_answer_contacts(const NearmissAnswer *answer,
                                      const NearmissContact **items,
                                      size_t *count,
                                      NearmissError *error);

// Feature pairs of a near query, in the order of contacts. The list lives as long as the answer.
NearmissCode nearmiss_answer_near_pairs(const NearmissAnswer *answer,
                                        const NearmissNearPair **items,
                                        size_t *count,
                                        NearmissError *error);

// The nearest triangles of a distance query. If no two bodies may collide, `is_any` is false and
// `nearest` is not written.
NearmissCode nearmiss_answer_nearest(const NearmissAnswer *answer,
                                     bool *is_any,
                                     NearmissNearest *nearest,
                                     NearmissError *error);

// Pairs of bodies that share a point, ascending by the first body, then by the second. The list
// lives as long as the answer.
NearmissCode nearmiss_answer_body_pairs(const NearmissAnswer *answer,
                                        const NearmissBodyPair **items,
                                        size_t *count,
                                        NearmissError *error);

// The nearest triangles of each two bodies within the distance, in the order of the bodies. The
// list lives as long as the answer.
NearmissCode nearmiss_answer_body_distances(const NearmissAnswer *answer,
                                            const NearmissNearest **items,
                                            size_t *count,
                                            NearmissError *error);

// Earliest time of contact of an earliest or a continuous query, in [0, 1]. No contact is earlier.
// If nothing collides, `is_any` is false and the time is 1. Triangles that cross at the start need
// not collide again: see `nearmiss_answer_is_free`.
NearmissCode nearmiss_answer_earliest(const NearmissAnswer *answer,
                                      bool *is_any,
                                      double *toi,
                                      NearmissError *error);

// Whether the answer proves that nothing touches. Continuous and earliest: the start was checked,
// no triangles share a point there, and nothing collides within the step. Discrete: no pair of
// triangles shares a point. Distance: it is above 0, or no two bodies may collide. Pairs of bodies:
// none shares a point. Distances of bodies: all are above 0. Near: always false.
NearmissCode nearmiss_answer_is_free(const NearmissAnswer *answer,
                                     bool *is_free,
                                     NearmissError *error);

// Frees the answer, with all lists and texts that it showed.
void nearmiss_answer_free(NearmissAnswer *answer);

// A deformable body without a mesh, in environment 0, that collides with all others and itself.
NearmissBody nearmiss_body(void);

// Copies a scene to a device. The detector answers queries of all kinds. Memory for a kind is
// taken by its first query. The scene cannot change any more; add bodies by
// `nearmiss_detector_add`. A scene without bodies has empty answers.
NearmissCode nearmiss_detector_create(const NearmissDevice *device,
                                      const NearmissScene *scene,
                                      NearmissDetector **detector,
                                      NearmissError *error);

// Default tolerance of continuous and earliest queries, a length: the smallest of all pairs of
// bodies. A pair has the smaller one of its bodies: 1e-4 of the body's mean edge.
NearmissCode nearmiss_detector_tolerance(NearmissDetector *detector,
                                         double *tolerance,
                                         NearmissError *error);

// Largest default tolerance of a pair of bodies, a length.
NearmissCode nearmiss_detector_largest_tolerance(NearmissDetector *detector,
                                                 double *tolerance,
                                                 NearmissError *error);

// Rebuilds tiles over moving bodies. It pays when bodies have moved far since tiles were built.
// Queries do it by themselves, except with `NEARMISS_REBUILD_MANUAL`.
NearmissCode nearmiss_detector_rebuild(NearmissDetector *detector, NearmissError *error);

// Frees the detector, after all that it has submitted. Its answers stay.
void nearmiss_detector_free(NearmissDetector *detector);

// Opens a machine. `backend` is a `NearmissBackend`. `threads` is the number of threads of a CPU,
// at most one a processor; 0 takes all. For `NEARMISS_CUDA` it must be 0; for `NEARMISS_AUTO` it
// is used if there is no GPU. Cost: about 0.1 s for the context of a GPU.
//
// Fails with `NEARMISS_DEVICE` if there is no such machine or its driver refuses.
NearmissCode nearmiss_device_open(uint32_t backend,
                                  size_t threads,
                                  NearmissDevice **device,
                                  NearmissError *error);

// Opens a GPU by its number in the driver, in its primary context, as CUDA's runtime does.
NearmissCode nearmiss_device_gpu(uint32_t ordinal, NearmissDevice **device, NearmissError *error);

// A GPU by a context and a stream of the caller. All work goes to that stream, after earlier work.
// `context` is a `CUcontext`, or NULL for that of the stream; of a default stream it is the current
// one of the thread. `stream` is a `CUstream` or a `cudaStream_t`, or NULL for the default stream,
// which a graph cannot capture.
//
// # Safety
// The stream is of that context, and both outlive the device and all detectors made with it.
NearmissCode nearmiss_device_from_stream(void *context,
                                         void *stream,
                                         NearmissDevice **device,
                                         NearmissError *error);

// Name of the machine. The text lives as long as the device.
NearmissCode nearmiss_device_name(const NearmissDevice *device,
                                  const char **name,
                                  NearmissError *error);

// Whether the machine is a GPU.
NearmissCode nearmiss_device_is_gpu(const NearmissDevice *device,
                                    bool *is_gpu,
                                    NearmissError *error);

// Sets a limit of the machine's memory in bytes, for all of its detectors together, from now on.
NearmissCode nearmiss_device_set_memory_limit(const NearmissDevice *device,
                                              uint64_t bytes,
                                              NearmissError *error);

// Frees the handle. Detectors of the device stay.
void nearmiss_device_free(NearmissDevice *device);

// Adds a body, and writes its number to `id`, which may be NULL. Numbers of removed bodies are
// used again. The next query rebuilds.
//
// # Safety
// Memory that the body points to is there.
NearmissCode nearmiss_detector_add(NearmissDetector *detector,
                                   const NearmissBody *body,
                                   uint32_t *id,
                                   NearmissError *error);

// Replaces a body by another, of any mesh, under the same number. The next query rebuilds.
//
// # Safety
// Memory that the body points to is there.
NearmissCode nearmiss_detector_replace(NearmissDetector *detector,
                                       uint32_t id,
                                       const NearmissBody *body,
                                       NearmissError *error);

// Removes a body. The others keep their numbers. The next query rebuilds.
NearmissCode nearmiss_detector_remove(NearmissDetector *detector,
                                      uint32_t id,
                                      NearmissError *error);

// Sets the thickness of a body, from the next query on, which rebuilds: `count` radii, as those of
// `NearmissBody`. If it is the same, nothing changes. Another one ends the preparation of
// submissions.
//
// Fails with `NEARMISS_INVALID_ARGUMENT` for a radius that is no length, and for another number of
// radii. Then the thickness is as before.
//
// # Safety
// `radii` points to that many numbers.
NearmissCode nearmiss_detector_set_thickness(NearmissDetector *detector,
                                             uint32_t id,
                                             const double *radii,
                                             size_t count,
                                             NearmissError *error);

// Replaces the list of pairs of bodies that are not tested against each other, by any query: as
// the links of a robot that share a joint. `pairs` has `count` pairs, two numbers of bodies each.
// Order and repeats do not matter; a count of 0 leaves out none.
//
// Fails with `NEARMISS_INVALID_ARGUMENT` for a body that is not in the scene, for a body with
// itself, and for a scene of which a detector has a copy. Then the list is as before.
//
// # Safety
// `pairs` points to that many numbers.
NearmissCode nearmiss_scene_leave_out(NearmissScene *scene,
                                      const uint32_t *pairs,
                                      size_t count,
                                      NearmissError *error);

// As `nearmiss_scene_leave_out`, from the next query on, which rebuilds. A removed body takes its
// pairs with it, a replaced one keeps them. Another list ends the preparation of submissions.
//
// # Safety
// `pairs` points to that many numbers.
NearmissCode nearmiss_detector_leave_out(NearmissDetector *detector,
                                         const uint32_t *pairs,
                                         size_t count,
                                         NearmissError *error);

// Writes the pairs of bodies that are left out, two numbers each: the smaller one first,
// ascending. They live until a call changes the bodies or the list.
NearmissCode nearmiss_detector_left_out(NearmissDetector *detector,
                                        const uint32_t **pairs,
                                        size_t *count,
                                        NearmissError *error);

// The exit status of the command line for a code: 0 success, 2 invalid argument, 3 invalid input,
// 130 interrupted, 4 all others.
uint32_t nearmiss_exit_code(uint32_t code);

// No exclusions.
NearmissExclusions nearmiss_exclusions(void);

// Replaces the exclusions of a body, from the next query on, which rebuilds. Queries of
// features and of triangles obey. Those of distances and of pairs of bodies fail if there are
// exclusions. A body that is removed or replaced loses its exclusions: its vertices may have
// other numbers. Other exclusions end the preparation of submissions.
//
// Fails with `NEARMISS_INVALID_ARGUMENT` for a body or a face that does not exist, a length
// that is negative or not finite, and a rest shape of another number of vertices. Fails with
// `NEARMISS_INPUT` for positions that are not finite. Then nothing has changed.
//
// # Safety
// Memory that the exclusions point to is there.
NearmissCode nearmiss_detector_exclude(NearmissDetector *detector,
                                       uint32_t body,
                                       const NearmissExclusions *exclusions,
                                       NearmissError *error);

// Replaces the list of pairs of vertices of two bodies, or of one with itself, of which
// features are not tested against each other. `pairs` has `count` pairs: a vertex of body `a`,
// and one of body `b`. Order and repeats do not matter; a count of 0 leaves out none. A body
// that is removed or replaced takes its lists with it.
//
// Fails with `NEARMISS_INVALID_ARGUMENT` for a body or a vertex that does not exist, and for a
// vertex with itself. Then the list is as before.
//
// # Safety
// `pairs` points to that many pairs of numbers.
NearmissCode nearmiss_detector_exclude_pairs(NearmissDetector *detector,
                                             uint32_t a,
                                             uint32_t b,
                                             const uint32_t *pairs,
                                             size_t count,
                                             NearmissError *error);

// No parts.
NearmissDeviceExtras nearmiss_device_extras(void);

// As `nearmiss_detector_prepare`, with parts of the answers that submissions also make on the
// device: geometry of rows, rows by feature, the least time or distance of each vertex.
// `nearmiss_detector_extras_on_device` returns their addresses. Contacts at the earliest time are
// in the lists of `nearmiss_detector_on_device`.
//
// Fails as there; with `NEARMISS_INVALID_ARGUMENT` if no query can have a part, and for geometry of
// a step in which a rigid body may turn. Several devices have no contacts at the earliest time.
//
// # Safety
// As of `nearmiss_detector_prepare`. So many numbers are in `grouped_by`.
NearmissCode nearmiss_detector_prepare_with(NearmissDetector *detector,
                                            const NearmissMotion *motions,
                                            size_t motion_count,
                                            const NearmissQuery *queries,
                                            size_t query_count,
                                            const NearmissDeviceExtras *extras,
                                            NearmissError *error);

// Addresses of the parts of the answer to a prepared query, for kernels of the caller on the same
// stream. Call it after each `nearmiss_detector_prepare_with`. Fails as
// `nearmiss_detector_on_device`.
//
// # Safety
// The names of the query are texts or NULL.
NearmissCode nearmiss_detector_extras_on_device(NearmissDetector *detector,
                                                const NearmissQuery *query,
                                                NearmissExtrasOnDevice *extras,
                                                NearmissError *error);

// Moves bodies for the next queries. Positions are uploaded once, for any number of queries. A
// body that is not named rests where it was, or where its step ended.
//
// Fails with `NEARMISS_INVALID_ARGUMENT` for a body that is not there, or named twice, or given a
// motion that its kind does not take. Fails with `NEARMISS_INPUT` for positions that no mesh may
// have. Then nothing has moved. Positions in memory of a GPU are checked when a query reads them.
//
// # Safety
// So many motions are there, and the memory that they name.
NearmissCode nearmiss_detector_update(NearmissDetector *detector,
                                      const NearmissMotion *motions,
                                      size_t motion_count,
                                      NearmissError *error);

// Answers a query of the bodies where they are. The answer depends on positions and on the query
// alone, not on earlier queries. Memory for a kind of query is taken by its first query; other
// numbers of the same kind rebuild nothing.
//
// Fails with `NEARMISS_INVALID_ARGUMENT` for numbers without a meaning. A continuous or an
// earliest query fails so if the last update named bodies and no step. There is no partial answer.
//
// # Safety
// The names of the query are texts or NULL.
NearmissCode nearmiss_detector_query(NearmissDetector *detector,
                                     const NearmissQuery *query,
                                     NearmissAnswer **answer,
                                     NearmissError *error);

// The contacts at the time of an answer to an earliest query: the rows of the continuous query with
// the same options whose time it is. Read them by `nearmiss_answer_contacts`. The bodies must be
// where they were at the query. The step is tested again, up to that time; with a minimum
// separation, all of it.
//
// Fails with `NEARMISS_INVALID_ARGUMENT` for an answer to another query, and if nothing begins at
// that time where the bodies are now.
NearmissCode nearmiss_detector_first_contacts(NearmissDetector *detector,
                                              const NearmissAnswer *first,
                                              NearmissAnswer **answer,
                                              NearmissError *error);

// Updates and queries in one submission: `nearmiss_detector_update`, then
// `nearmiss_detector_query`. An error of the motions or of the query's numbers has moved nothing.
//
// # Safety
// So many motions are there, and the memory that they name. The names of the query are texts or
// NULL.
NearmissCode nearmiss_detector_step(NearmissDetector *detector,
                                    const NearmissMotion *motions,
                                    size_t motion_count,
                                    const NearmissQuery *query,
                                    NearmissAnswer **answer,
                                    NearmissError *error);

// Geometry of every row of an answer to a continuous or a near query, in the order of its rows.
// The bodies must be where they were at the query. The list lives until the next call of this
// function with the answer. Cost: a copy of all vertices from the device, and a wait.
NearmissCode nearmiss_detector_geometry(NearmissDetector *detector,
                                        NearmissAnswer *answer,
                                        const NearmissGeometry **items,
                                        size_t *count,
                                        NearmissError *error);

// How the triangles of every row of an answer to a discrete query meet, in the order of its rows.
// The bodies must be where they were at the query. The list lives until the next call of this
// function with the answer. The solver "moller" has no such list. Cost: some microseconds a row.
NearmissCode nearmiss_detector_pair_geometry(NearmissDetector *detector,
                                             NearmissAnswer *answer,
                                             const NearmissPairGeometry **items,
                                             size_t *count,
                                             NearmissError *error);

// Groups the rows of an answer to a continuous, near or discrete query by features of a body. `by`
// is a `NearmissGroupBy`; triangle pairs have faces and corners alone. The bodies must be those of
// the query. The lists live until the next call of this function with the answer. Cost: linear, on
// the host.
//
// Fails with `NEARMISS_INVALID_ARGUMENT` for other answers, and if there is no such body.
NearmissCode nearmiss_detector_grouped(NearmissDetector *detector,
                                       NearmissAnswer *answer,
                                       uint32_t body,
                                       uint32_t by,
                                       NearmissGrouped *grouped,
                                       NearmissError *error);

// The least time of contact, or the least distance, of each vertex of a body: over the rows of an
// answer to a continuous or a near query in which it takes part, infinity without one. Times are
// `toi`; distances are those of surfaces, without thickness. The list lives until the next call of
// this function with the answer.
//
// Vertices that stop at different times leave the straight lines that were tested: query the
// shortened step again. Fails as `nearmiss_detector_grouped`.
NearmissCode nearmiss_detector_least_by_vertex(NearmissDetector *detector,
                                               NearmissAnswer *answer,
                                               uint32_t body,
                                               const double **items,
                                               size_t *count,
                                               NearmissError *error);

// The curves in which surfaces cross: the segments of the rows of an answer to a discrete query
// that cross, chained by the vertices, edges and faces that hold their ends. The bodies must be
// where they were at the query. The lists live until the next call of this function with the
// answer. Cost: that of `nearmiss_detector_pair_geometry`.
//
// A curve ends at a border of a mesh, at a seam of vertices with equal coordinates, where it runs
// along an edge that is on a face, and where more than two surfaces meet. It runs along the product
// of both normals, the first row's first triangle times its second.
NearmissCode nearmiss_detector_curves(NearmissDetector *detector,
                                      NearmissAnswer *answer,
                                      NearmissCurves *curves,
                                      NearmissError *error);

// Makes a handle, for `nearmiss_device_with_interrupt`.
NearmissCode nearmiss_interrupt_create(NearmissInterrupt **interrupt, NearmissError *error);

// A handle that ends calls of a detector. Free it before or after the detector.
NearmissCode nearmiss_detector_interrupter(const NearmissDetector *detector,
                                           NearmissInterrupt **interrupt,
                                           NearmissError *error);

// Another handle of the same machine. The interrupt ends calls of detectors that are made with it.
// Free it as any device.
NearmissCode nearmiss_device_with_interrupt(const NearmissDevice *device,
                                            const NearmissInterrupt *interrupt,
                                            NearmissDevice **made,
                                            NearmissError *error);

// Ends the call that runs or, if none runs, the next one. The call returns `NEARMISS_INTERRUPTED`
// and no answer; the detector can be used again. Bodies that the call named have moved. Safe in a
// signal handler: one atomic store. NULL does nothing.
void nearmiss_interrupt(const NearmissInterrupt *interrupt);

// Clears an interrupt that has ended no call yet. Safe in a signal handler.
void nearmiss_interrupt_clear(const NearmissInterrupt *interrupt);

// Frees the handle. Its devices and detectors stay.
void nearmiss_interrupt_free(NearmissInterrupt *interrupt);

// The pose of a matrix of 16 doubles, row by row: a rotation and, in the last column, a
// translation. The last row is 0 0 0 1. Columns may be off unit length, and scalar products of two
// of them off 0, by up to 1.19e-4; the nearest rotation is taken.
//
// Fails with `NEARMISS_INPUT` for a number that is not finite, another last row, scale, shear and a
// mirror image. The message names the number.
//
// # Safety
// A `matrix` that is not NULL has 16 doubles.
NearmissCode nearmiss_pose_from_matrix(const double *matrix,
                                       NearmissPose *pose,
                                       NearmissError *error);

// Writes the matrix of a pose as 16 doubles, row by row: see `nearmiss_pose_from_matrix`. The
// quaternion is normalised first.
//
// # Safety
// A `matrix` that is not NULL has room for 16 doubles.
NearmissCode nearmiss_pose_matrix(NearmissPose pose, double *matrix, NearmissError *error);

// A deformable body at rest. If the positions are in memory of the device, set `on_device` then.
NearmissMotion nearmiss_motion_positions(uint32_t body, NearmissRows positions);

// A deformable body that moves, each vertex in a straight line. If the positions are in memory of
// the device, set `on_device` then.
NearmissMotion nearmiss_motion_step(uint32_t body, NearmissRows start, NearmissRows end);

// A rigid body at rest.
NearmissMotion nearmiss_motion_pose(uint32_t body, NearmissPose pose);

// A rigid body that moves from one pose to another. It turns by the shorter arc about the origin of
// its mesh. Set `pivot` for another point, or `straight` for straight lines.
NearmissMotion nearmiss_motion_pose_step(uint32_t body, NearmissPose start, NearmissPose end);

// A rigid body that begins in a pose and turns by a rotation vector. Set `turn` then, and `travel`
// and `pivot` unless they are 0. Turns of more than 180 degrees need it: two poses cannot give
// them.
NearmissMotion nearmiss_motion_turning(uint32_t body, NearmissPose start);

// Writes the number of the body with that name to `id`.
//
// Fails with `NEARMISS_INVALID_ARGUMENT` if no body has the name, or several have. The message
// lists them.
//
// # Safety
// `name` is a text.
NearmissCode nearmiss_scene_id(const NearmissScene *scene,
                               const char *name,
                               uint32_t *id,
                               NearmissError *error);

// Writes the number of the body with that name to `id`. Fails as `nearmiss_scene_id`.
//
// # Safety
// `name` is a text.
NearmissCode nearmiss_detector_id(NearmissDetector *detector,
                                  const char *name,
                                  uint32_t *id,
                                  NearmissError *error);

// Writes the name of a body, in UTF-8, to `name`. The text lives until the next call of this
// function with the detector.
NearmissCode nearmiss_detector_name(NearmissDetector *detector,
                                    uint32_t body,
                                    const char **name,
                                    NearmissError *error);

// Makes the notes of an answer and counts them. Read each by `nearmiss_answer_note`. The bodies
// must be where they were at the query. Most answers have none. Cost: a comparison of both ends of
// the step if nothing moves; a sort of all vertices from 1,000 rows on.
NearmissCode nearmiss_detector_notes(NearmissDetector *detector,
                                     NearmissAnswer *answer,
                                     size_t *count,
                                     NearmissError *error);

// A note that `nearmiss_detector_notes` made, by its index from 0. The text lives until notes are
// made again, at most as long as the answer.
NearmissCode nearmiss_answer_note(const NearmissAnswer *answer,
                                  size_t index,
                                  const char **note,
                                  NearmissError *error);

// A caveat of an answer, by its index from 0: a limit that was reached, in a sentence. The summary
// counts them. No collision of the given motions is missed for any of them. The text lives as long
// as the answer.
NearmissCode nearmiss_answer_caveat(const NearmissAnswer *answer,
                                    size_t index,
                                    const char **caveat,
                                    NearmissError *error);

// Addresses of the answer to a prepared query, for kernels of the caller on the same stream. Call
// it after each `nearmiss_detector_prepare`. Fails with `NEARMISS_INVALID_ARGUMENT` if the query is
// not prepared with these numbers, or no two bodies may collide.
//
// # Safety
// The names of the query are texts or NULL.
NearmissCode nearmiss_detector_on_device(NearmissDetector *detector,
                                         const NearmissQuery *query,
                                         NearmissDeviceAnswer *answer,
                                         NearmissError *error);

// The same for a detector on several devices: the answer of each to its share, in its memory, and
// behind the work of its stream. An earliest query has the time of each share. There are as many
// answers as devices, in their order. A detector on one device has one.
//
// Fails as `nearmiss_detector_on_device` does, and for another number of answers.
//
// # Safety
// There is room for so many answers. The names of the query are texts or NULL.
NearmissCode nearmiss_detector_on_each_device(NearmissDetector *detector,
                                              const NearmissQuery *query,
                                              NearmissDeviceAnswer *answers,
                                              size_t answer_count,
                                              NearmissError *error);

// The plan of the last frame of a query, as JSON: launches (`build`, `frame`), memory by its use
// (`buffers`), bytes copied to the device and back (`transfers`), and stages that the scene does
// not need (`left_out`). All are the device's own counts. The text lives until the next plan of
// the detector. If the last two frames were not of this query, the call runs it.
//
// # Safety
// The names of the query are texts or NULL.
NearmissCode nearmiss_detector_plan(NearmissDetector *detector,
                                    const NearmissQuery *query,
                                    const char **json,
                                    NearmissError *error);

// Poses of many bodies in memory of the host. If they are in memory of the device, set `on_device`
// then.
NearmissPoseRows nearmiss_pose_rows(NearmissRows positions, NearmissRows quaternions);

// Moves many rigid bodies at once: `bodies[k]` to row `k` of the poses. As
// `nearmiss_detector_update` with a pose for each, or with a pose step if `end` is not NULL. Bodies
// that are not named rest.
//
// Fails with `NEARMISS_INVALID_ARGUMENT` for other numbers of rows, and for a body that is not
// there, named twice or not rigid. Fails with `NEARMISS_INPUT` for an invalid pose. The message
// names the row and the body, and nothing has moved. Poses in memory of a GPU are checked when a
// query reads them.
//
// # Safety
// So many numbers of bodies are there, and the rows.
NearmissCode nearmiss_detector_update_poses(NearmissDetector *detector,
                                            const uint32_t *bodies,
                                            size_t body_count,
                                            const NearmissPoseRows *start,
                                            const NearmissPoseRows *end,
                                            NearmissError *error);

// Poses of a rigid body at the start and at the end of its step, equal if it rests. Either may be
// NULL. Cost: if a body was moved from memory of the device, a copy of all vertices, and a wait.
NearmissCode nearmiss_detector_body_poses(NearmissDetector *detector,
                                          uint32_t body,
                                          NearmissPose *start,
                                          NearmissPose *end,
                                          NearmissError *error);

// Positions of a body at the start and at the end of the step, as three doubles a vertex. `start`
// and `end` have room for `vertex_count` vertices, as many as the body has. Either may be NULL.
// Both ends are equal for a body at rest. Vertices of a rigid body are in its poses. Cost: if a
// body was moved from memory of the device, a copy of all vertices, and a wait.
//
// # Safety
// A pointer that is not NULL has room for three doubles a vertex.
NearmissCode nearmiss_detector_download_positions(NearmissDetector *detector,
                                                  uint32_t body,
                                                  double *start,
                                                  double *end,
                                                  size_t vertex_count,
                                                  NearmissError *error);

// A query of a `NearmissQueryKind` with defaults. Set `distance` of a near query, and of one for
// distances of bodies.
NearmissQuery nearmiss_query(uint32_t kind);

// `count` rows of floats without gaps: points of three, or quaternions of four.
NearmissRows nearmiss_floats(const float *points, size_t count);

// `count` rows of doubles without gaps: points of three, or quaternions of four.
NearmissRows nearmiss_doubles(const double *points, size_t count);

// A scene without bodies.
NearmissCode nearmiss_scene_create(NearmissScene **scene, NearmissError *error);

// Adds a body and writes its number to `id`, which may be NULL. Numbers count from 0. Cost: a copy
// of the mesh, and a pass over it.
//
// Fails with `NEARMISS_INPUT` for positions that are not finite or too large and for indices out
// of range, naming the first. Fails with `NEARMISS_INVALID_ARGUMENT` for a field without a
// meaning, and for a scene of which a detector has a copy. Then nothing is added.
//
// # Safety
// Memory that the body points to is there.
NearmissCode nearmiss_scene_add(NearmissScene *scene,
                                const NearmissBody *body,
                                uint32_t *id,
                                NearmissError *error);

// Frees the scene. Detectors keep their copies.
void nearmiss_scene_free(NearmissScene *scene);

// Copies a scene to several devices of one host, which divide the work of each query. Each has all
// positions and finds the pairs of its share; answers and hashes are those of one device. `devices`
// points to `device_count` handles, at least one. See `nearmiss_detector_create`.
//
// The detector takes the calls of any other, except `nearmiss_detector_on_device`, `_plan` and
// `_update_poses`; distances, pairs of bodies and trees are not divided. These fail with
// `NEARMISS_INVALID_ARGUMENT`, and so do motions in memory of a GPU if a device is a CPU. Motions
// may be in memory of any of the GPUs, behind the work of its stream. All devices have read them
// when `nearmiss_detector_update` returns, and before what follows a submission on that stream. No
// CUDA graph can capture a submission.
//
// # Safety
// So many handles are there. One thread at a time uses each device.
NearmissCode nearmiss_detector_create_on_several(const NearmissDevice *const *devices,
                                                 size_t device_count,
                                                 const NearmissScene *scene,
                                                 NearmissDetector **detector,
                                                 NearmissError *error);

// Writes each device's share of the last frame of a query: as many as the detector has devices.
// Shares are 0 before the first frame.
//
// Fails with `NEARMISS_INVALID_ARGUMENT` for another number of shares, and for a detector that
// `nearmiss_detector_create` made.
//
// # Safety
// There is room for so many shares. The names of the query are texts or NULL.
NearmissCode nearmiss_detector_shares(NearmissDetector *detector,
                                      const NearmissQuery *query,
                                      NearmissShare *shares,
                                      size_t share_count,
                                      NearmissError *error);

// Prepares submissions of several queries. Each motion is in memory of the device (`on_device` is
// 1); write new positions there between submissions. Bodies that are not named rest. The call
// runs the queries and takes all memory. `nearmiss_detector_submit` then allocates nothing and
// waits for nothing. Any other call that changes the detector ends the preparation.
//
// Fails with `NEARMISS_INVALID_ARGUMENT` for no query, and for two queries that differ in numbers
// alone.
//
// # Safety
// So many motions and queries are there. Memory of the motions stays until the next update or the
// end of the detector. The names of the queries are texts or NULL.
NearmissCode nearmiss_detector_prepare(NearmissDetector *detector,
                                       const NearmissMotion *motions,
                                       size_t motion_count,
                                       const NearmissQuery *queries,
                                       size_t query_count,
                                       NearmissError *error);

// Whether the detector is prepared: `nearmiss_detector_submit` may be called, and a recording of
// it may be launched again. Nothing has changed the detector since `nearmiss_detector_prepare`.
NearmissCode nearmiss_detector_is_prepared(NearmissDetector *detector,
                                           bool *is_prepared,
                                           NearmissError *error);

// Submits the prepared queries to the stream of the device. Positions are read there when its turn
// comes. The call launches kernels and does nothing else, so a CUDA graph may capture it and be
// launched any number of times. On a CPU the work is done when the call returns.
NearmissCode nearmiss_detector_submit(NearmissDetector *detector, NearmissError *error);

// Waits for the last submission, or for the last launch of its recording, and copies the answer to
// one of its queries. If a list was too short it grows and the query runs again: the answer is
// whole, and the detector is no longer prepared. A query that was not prepared with these numbers
// runs too, with the bodies where they are.
//
// # Safety
// The names of the query are texts or NULL.
NearmissCode nearmiss_detector_collect(NearmissDetector *detector,
                                       const NearmissQuery *query,
                                       NearmissAnswer **answer,
                                       NearmissError *error);

// Figures of an answer: rows, candidates, times. Cost: a pass over the rows, for their hash.
NearmissCode nearmiss_answer_summary(const NearmissAnswer *answer,
                                     NearmissSummary *summary,
                                     NearmissError *error);

#ifdef __cplusplus
}  // extern "C"
#endif  // __cplusplus

#endif  /* NEARMISS_H */
