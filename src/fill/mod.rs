//! Filling holes: planning, verification, stitching, report.

mod attributes;
mod hole;
mod index;
pub(crate) mod pipeline;
mod plan;
mod polyline;
pub(crate) mod progress;
pub(crate) mod report;
pub(crate) mod session;
mod stitch;
mod verify;

#[cfg(test)]
mod tests;
