//! Filling holes: planning, verification, stitching, report.

mod attributes;
mod cut;
mod index;
mod patch;
mod plan;
mod polyline;
pub(crate) mod progress;
pub(crate) mod report;
pub(crate) mod session;
mod stitch;
mod verify;

#[cfg(test)]
mod tests;
