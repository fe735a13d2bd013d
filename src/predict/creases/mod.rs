//! Continues the creases of the known surface across a hole.
//!
//! Each region round the hole gets a surface of its own ([`region`]); creases are the curves in which two of these
//! meet, corners the points where three do ([`intersection`]). [`slide`] finds where they leave the rim, [`partition`] finds out which creases meet and cuts
//! the hole along them into one face per region.

pub(crate) mod intersection;
pub(crate) mod partition;
pub(crate) mod region;
pub(crate) mod slide;
