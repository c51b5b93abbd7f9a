//! Purpose of each kernel.

/// Stages of a frame, in their order, and the purpose of each.
pub const STAGES: [(&str, &str); 10] = [
    ("place", "vertices where the frame puts them"),
    ("construct", "the level-ordered tree"),
    ("fit", "volumes of the leaves"),
    ("refit", "volumes of all other nodes"),
    ("traverse", "candidate triangle pairs"),
    ("balance", "work queues of equal length"),
    ("narrow", "contacts of the candidates"),
    ("order", "contacts in canonical order"),
    ("answer", "parts of a submitted answer, on request"),
    ("status", "whether a submitted frame is complete"),
];

/// Stage of kernels that no stage names.
const ORDER: usize = 7;

/// Kernels by the beginnings of their names, the longer ones first, and the purpose of each.
const KERNELS: [(&str, &str); 120] = [
    ("place_starts", "positions at t = 0, stored apart from those at the end"),
    ("place_turns", "rotation vectors and paths of bodies that turn"),
    ("place_poses", "poses of instances, from the caller's memory and the host"),
    ("place", "poses applied, uploads put in place, other bodies at rest"),
    ("construct_bounds", "the box of each body's centres"),
    ("construct_runs", "runs of 16 tiles in halves of halves, on chip"),
    ("construct_morton", "a code along a curve for each triangle, after its body's prefix"),
    ("construct_tile_filters", "bodies of the triangles below each tile and node"),
    ("construct_treelets", "groups of leaves that are refitted together"),
    ("construct_tree", "the radix tree"),
    ("construct_depth", "each node's depth"),
    ("construct_places", "each node's place in its level"),
    ("construct_emit", "nodes in level order"),
    ("construct_graft", "the fixed tree after the other, once"),
    ("sort_pass", "a pass of the radix sort"),
    ("fit_bodies", "a place and a box for each body, and boxes of groups"),
    ("fit_moving_bodies", "places and a box for each body around its step, and boxes of groups"),
    ("fit_tiles", "a volume for each triangle, tile, and 16 tiles"),
    ("fit_rims", "edges opposite to hubs: a volume for each tile and node"),
    ("fit_groups", "nodes of few leaves, from their points"),
    ("fit", "a volume for each leaf"),
    ("refit_levels", "the volumes of a level"),
    ("refit_treelets", "leaves and all other volumes in one launch"),
    ("refit_tiles", "a volume for 16 nodes, for each further level"),
    ("refit_meshes_vertices", "vertices of deformable bodies, for their meshes"),
    ("refit_meshes_corners", "their triangles"),
    ("refit_meshes_spread", "their vertices, among those of candidates"),
    ("refit_meshes_swept", "their triangles, and boxes around a step"),
    ("refit_meshes_nodes", "boxes of their nodes, for each level"),
    ("refit_meshes_records", "boxes and radii of their meshes"),
    ("traverse_relations_within", "bodies in the frames of others, if their meshes may be near"),
    ("traverse_nodes_within", "pairs of nodes of two meshes within the bound, a level lower"),
    ("traverse_instances_within", "triangles of pairs of tiles within the bound, by boxes"),
    ("traverse_bounds", "bounds of distances, from boxes"),
    ("traverse_left_out", "candidates of bodies that are not left out"),
    ("traverse_corners", "bounds of distances, from corners"),
    ("traverse_touching", "bodies that share a point, by the triangles of pairs of tiles"),
    ("traverse_relations", "bodies in the frames of others, if their meshes may meet"),
    ("traverse_nodes", "pairs of nodes of two meshes, a level lower"),
    ("traverse_instances", "triangles of pairs of tiles of two bodies, by boxes and planes"),
    ("traverse_moving_relations", "the same around a step, if their meshes may meet in it"),
    ("traverse_moving_nodes", "pairs of nodes around a step, a level lower"),
    ("traverse_moving_instances", "triangles of pairs of tiles around a step, by boxes and planes"),
    ("traverse_vertices", "vertices of candidates, placed once each"),
    ("traverse_leaves", "a walk for each leaf"),
    ("traverse_units", "work units given up by long walks"),
    ("traverse_sample", "the nearest of a few leaves, for a bound"),
    ("traverse_within", "a walk for each leaf, within the bound"),
    ("traverse_queue", "pairs of nodes from work queues"),
    ("traverse_steal", "pairs of nodes from queues with stealing"),
    ("traverse_front", "pairs of nodes from the end of the last frame's descent"),
    ("traverse_tiles_before", "pairs of tiles that meet before the earliest time"),
    ("traverse_triangles_before", "their triangles, all against all, before the earliest time"),
    ("traverse_tiles", "pairs of tiles"),
    ("traverse_triangles", "triangles of pairs of tiles, all against all"),
    ("balance_copy", "equally many units in each queue"),
    ("narrow_moller", "the float test of two triangles"),
    ("narrow_filter_placed", "signs in f64, of vertices placed as they are read"),
    ("narrow_exact_placed", "exact signs of such, of pairs left uncertain"),
    ("narrow_filter", "signs in the positions' precision"),
    ("narrow_wide", "signs in f64, of pairs left uncertain"),
    ("narrow_exact", "exact signs, of pairs left uncertain"),
    ("narrow_start_filter", "triangles that share a point at the start: boxes and signs"),
    ("narrow_start_wide", "the same in f64, of pairs left uncertain"),
    ("narrow_start_exact", "the same by exact signs, of pairs left uncertain"),
    ("narrow_features_thick_at_rest", "vertex/face and edge/edge pairs by their boxes and thickness"),
    ("narrow_features_thick", "the same in motion"),
    ("narrow_features_at_rest", "vertex/face and edge/edge pairs by their boxes"),
    ("narrow_features_before", "the same that meet before the earliest time"),
    ("narrow_features", "vertex/face and edge/edge pairs by their boxes in motion"),
    ("narrow_cull", "pairs that signs reject"),
    ("narrow_vf", "vertex/face pairs, by the cubic"),
    ("narrow_ee", "edge/edge pairs, by the cubic"),
    ("narrow_below_precision", "contacts too large for the tolerance, counted"),
    ("narrow_isolate", "roots isolated, each with a certificate"),
    ("narrow_settle", "exact touching at the start"),
    ("narrow_slice", "the step in slices, and the search by boxes"),
    ("narrow_approach_signs", "those that come nearer than at the start, by bounds of errors"),
    ("narrow_approach_exact", "the same in integers, of pairs left uncertain"),
    ("narrow_approach_advance", "times at which others do, by advancement"),
    ("narrow_approach", "pairs that may be near at the start"),
    ("narrow_part", "supporting planes, by the largest radius of each pair"),
    ("narrow_separate_thick", "supporting planes, of radii that differ"),
    ("narrow_separate", "supporting planes"),
    ("narrow_first_pairs", "pairs that may begin at the earliest time"),
    ("narrow_first_hits", "contacts at the earliest time"),
    ("narrow_divide_thick", "candidates without a thickness, and those with one"),
    ("narrow_sift_thick", "feature pairs without a thickness, and those with one"),
    ("narrow_divide", "candidates of bodies that turn, and of those that go straight"),
    ("narrow_turning_chords", "features of those that no plane keeps apart, by their chords"),
    ("narrow_turning_features", "the same of bodies that turn far"),
    ("narrow_turning_common", "contacts on arcs of features that meet once"),
    ("narrow_turning", "contacts on arcs, slice by slice"),
    ("narrow_least", "the least distance of triangles"),
    ("narrow_witness", "the first pair with the least distance"),
    ("narrow_nearest", "nearest points of that pair"),
    ("narrow_bodies_exact", "exact signs of those left uncertain"),
    ("narrow_bodies_meeting", "pairs of bodies that share a point"),
    ("narrow_bodies_least", "the least distance of each pair of bodies"),
    ("narrow_bodies_first", "the first triangles at that distance"),
    ("narrow_bodies_nearest", "nearest points of these"),
    ("narrow_near_thick", "distances of feature pairs, and radii of their corners"),
    ("narrow_near_open", "radii of nearest points, and exclusions"),
    ("narrow_near_excluding", "distances of feature pairs, without those excluded"),
    ("narrow_exclude_triangles", "triangle pairs that are not excluded"),
    ("narrow_exclude", "feature pairs that are not excluded"),
    ("narrow_near", "distances of feature pairs"),
    ("order_count", "contacts of each first feature"),
    ("order_sums", "contacts of each tile of bins"),
    ("order_starts", "the first contact of each bin"),
    ("order_place", "a key for each contact, in its bin"),
    ("order_merge", "runs of keys in long bins"),
    ("order_rank", "rows in the order of their keys"),
    ("answer_geometry", "vertices, weights, points and normal of each row"),
    ("answer_infinite", "no time and no distance yet"),
    ("answer_least", "the least time or distance of each vertex"),
    ("answer_keys", "a key for each feature of each row"),
    ("answer_groups", "rows of each feature"),
    ("status_frame", "count and capacity of each list"),
    ("status_again", "the same, with those of a second pass"),
];

/// Returns the stage of a kernel, and its purpose. `building` decides if the radix sort is part of
/// construction or of ordering.
pub fn of(kernel: &str, building: bool) -> (usize, &'static str) {
    let what = KERNELS.iter().find(|(start, _)| kernel.starts_with(start)).map_or("", |(_, what)| what);
    let own = kernel.split('_').next().unwrap_or_default();
    let stage = match (own, building) {
        ("sort", true) => "construct",
        ("sort", false) => "order",
        _ => own,
    };
    (STAGES.iter().position(|(name, _)| *name == stage).unwrap_or(ORDER), what)
}

#[cfg(test)]
mod tests {
    use super::*;
    use nearmiss_kernels::entry::TABLE;

    #[test]
    fn every_kernel_has_its_stage_and_its_words() {
        for (kernel, _) in TABLE {
            let (stage, what) = of(kernel, true);
            let own = kernel.split('_').next().expect("a name");
            assert_eq!(STAGES[stage].0, if own == "sort" { "construct" } else { own }, "{kernel}");
            assert!(!what.is_empty(), "{kernel}");
        }
        assert_eq!((STAGES[of("sort_pass", false).0].0, of("a_new_one", false).1), ("order", ""));
        // The longer beginning comes first, so that none hides another.
        for (at, (start, _)) in KERNELS.iter().enumerate() {
            let hidden = KERNELS[..at].iter().find(|(before, _)| start.starts_with(before));
            assert_eq!(hidden, None, "{start}");
        }
    }
}
