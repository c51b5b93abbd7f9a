//! Two primitives: the narrow tests.
