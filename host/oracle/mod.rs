//! Answers by exact rational arithmetic; imports nothing from the kernels.
