//! Judges: the oracles against answers that need no computing, and every judge shown to condemn.

mod can_fail;
mod discrete;
mod motion;
