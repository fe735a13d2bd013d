//! Boundary loops: finding, measuring, classifying and choosing them.

pub(crate) mod boundary_loop;
mod classify;
pub(crate) mod linked;
pub(crate) mod loops;
pub(crate) mod opening;
pub(crate) mod select;

#[cfg(test)]
mod loops_tests;
#[cfg(test)]
mod select_tests;
