//! A motion that no certificate decides.

/// Two edges, each of a large triangle, at the start and at the end of a step. They meet at a
/// sixteenth of the step, as one of them shrinks to a point. No certificate holds then, and no
/// slice decides it.
pub const SHRINKING: [[[f32; 3]; 6]; 2] = [
    [
        [0.0, 60.0, -12.0],
        [-24.0, 36.0, 12.0],
        [1e5, 0.0, 0.0],
        [-48.0, 24.0, 60.0],
        [-84.0, 24.0, -12.0],
        [-1e5, 0.0, 0.0],
    ],
    [
        [576.0, -708.0, 180.0],
        [-216.0, -732.0, 12.0],
        [1e5, 0.0, 0.0],
        [144.0, -552.0, -708.0],
        [684.0, -552.0, 372.0],
        [-1e5, 0.0, 0.0],
    ],
];
