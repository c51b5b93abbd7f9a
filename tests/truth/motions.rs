//! Motions that other libraries got wrong, as reported in public, with exact answers.

use nearmiss::extremes::Reported;

/// Report and id, vertex/face (else edge/edge), the four points at time 0 and 1, the longest time, the first contact.
pub const MOTIONS: [Reported; 12] = nearmiss::extremes::MOTIONS;
