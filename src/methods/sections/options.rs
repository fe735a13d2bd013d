//! The options that the methods `hpde`, `grey` and `nurbs` share.

use crate::options::entry::{choice, options};

/// How the tangents of a section at the rim are found.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SectionTangents {
    /// The intersection of the section plane with the triangle at the base point, as published.
    Chord,
    /// The intersection of the section plane with the tangent plane of a quadric fitted to the surroundings.
    Jet,
}

choice!(SectionTangents {
    Chord = "chord",
    Jet = "jet"
});

/// Where the predicted points are triangulated.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SectionProjection {
    /// `Planes`; if that fails, `Sections`.
    Auto,
    /// In one plane, or in two planes that are unfolded, as published.
    Planes,
    /// In a plane in which the sections are laid side by side.
    Sections,
}

choice!(SectionProjection {
    Auto = "auto",
    Planes = "planes",
    Sections = "sections"
});

options! {
    /// How sections are laid through a hole and triangulated.
    pub struct SectionOptions {
        /// Tangents of the arcs: from the triangle at the rim, or from a quadric fitted to the surroundings
        tangents: SectionTangents = SectionTangents::Jet, in ();
        /// Distance between base points, in mean edge lengths of the surroundings
        base_spacing: f64 = 0.8, in 0.1..=10.0;
        /// Distance between predicted points of a section, in mean edge lengths of the surroundings
        point_spacing: f64 = 1.0, in 0.1..=10.0;
        /// Dihedral angle A_c in degrees up to which the rim is seen as two parts on two planes
        segment_angle: f64 = 110.0, in 0.0..=180.0;
        /// Smallest angle I_c in degrees between a section and the rim
        skip_angle: f64 = 12.0, in 0.0..=45.0;
        /// Where points are triangulated: on one plane or two, on the sections side by side, or what fits first
        projection: SectionProjection = SectionProjection::Auto, in ();
        /// Smooth the patch
        smoothing: bool = true, in ();
        /// Steps of smoothing, NumSmooth
        smoothing_steps: usize = 60, in 0..=10_000;
        /// Shorter edges are collapsed, in mean edge lengths of the surroundings
        shortest_edge: f64 = 0.6, in 0.0..=1.0;
        /// Steps of smoothing of what is read of the surroundings, for noisy scans; the mesh itself stays
        denoise: usize = 0, in 0..=1000;
    }
}
