//! Fairing: moves the interior vertices of a patch so that it meets its surroundings smoothly.

pub(crate) mod kharmonic;
pub(crate) mod laplacian;

#[cfg(test)]
mod tests;
