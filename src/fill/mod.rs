//! Filling holes: options, planning, verification, stitching, report.

mod attributes;
mod hole;
pub(crate) mod method;
mod methods;
pub(crate) mod options;
pub(crate) mod pipeline;
mod plan;
pub(crate) mod progress;
pub(crate) mod report;
mod stitch;
mod verify;

#[cfg(test)]
mod tests;
