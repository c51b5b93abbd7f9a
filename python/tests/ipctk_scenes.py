"""Random meshes for ipctk: faces with common vertices, edges without faces, vertices without edges, edges in any order."""

import ipctk
import numpy as np


def scene(seed, dim, size=0.35):
    """A mesh, and its vertices at the start and at the end of a step."""
    random = np.random.default_rng(seed)
    groups, wanted = [], [(3, 10), (2, 6), (1, 5)] if dim == 3 else [(2, 14), (1, 6)]
    count = 0
    for corners, features in wanted:
        groups.append(np.arange(count, count + corners * features).reshape(-1, corners))
        count += corners * features
    vertices = np.concatenate([np.repeat(random.random((len(group), dim)), group.shape[1], axis=0) for group in groups])
    vertices += size * (random.random((count, dim)) - 0.5)
    faces = groups[0].copy() if dim == 3 else np.zeros((0, 3), int)
    bare = groups[-2].copy()
    # Chains of faces and of edges with common vertices.
    for group in (faces, bare):
        for at in range(1, len(group), 3):
            group[at, 0] = group[at - 1, -1]
    edges = np.concatenate([bare, ipctk.edges(faces.astype(np.int32))]) if len(faces) else bare
    edges = random.permuted(edges, axis=1)[random.permutation(len(edges))]
    ends = [np.asfortranarray(vertices), np.asfortranarray(vertices + 0.5 * (random.random((count, dim)) - 0.5))]
    shapes = [np.asfortranarray(part.astype(np.int32)) for part in (edges, faces)]
    return ipctk.CollisionMesh(ends[0], *(shapes if dim == 3 else shapes[:1])), *ends
