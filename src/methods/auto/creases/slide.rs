//! Corrects the ends of creases that run along the rim before they enter the hole.
//!
//! Usually the patch continues, at each rim edge, the region of the known triangle there. But a rim edge can lie on a
//! crease itself. Then the patch continues the region on the other side of the crease, and the end of the crease moves
//! along the rim to the vertex where it really enters the hole.

use crate::error::{Error, Result};
use crate::hole::Hole;
use crate::math::unit;
use crate::methods::auto::creases::detect::Regions;
use crate::methods::auto::surface::{Implicit, project};

/// A rim vertex lies on a crease if its distance from both surfaces is below this, in mean rim edge lengths.
const ON_SURFACE: f64 = 0.1;

/// Lower bound on the cosine of the angle between a crease and a rim edge that lies on it.
const ALONG: f64 = 0.7;

/// Moves each end along the rim as long as the next rim vertex lies on both surfaces, and updates the regions of the
/// rim edges that it passes.
///
/// # Errors
/// [`ErrorKind::Geometry`] when no rim edge is left to a region.
pub(crate) fn slide_ends(
    hole: &Hole,
    regions: &mut Regions,
    surfaces: &[&dyn Implicit],
    step: f64,
) -> Result<()> {
    let len = hole.polygon.len();
    let point = |position: usize| hole.rim()[hole.polygon[position % len] as usize];
    for k in 0..regions.ends.len() {
        for _ in 0..len {
            let end = regions.ends[k];
            let here = end.position;
            let sides = [(here + len - 1) % len, here].map(|edge| regions.at_rim[edge]);
            let lies_on_crease = |position: usize| {
                let way = unit(point(position) - point(here));
                let is_on = |side: u32| {
                    let surface = surfaces[side as usize];
                    project::distance(surface, &point(position)) < ON_SURFACE * step
                };
                -way.dot(&end.outward) > ALONG && sides.into_iter().all(is_on)
            };
            let (ahead, behind) = ((here + 1) % len, (here + len - 1) % len);
            let to = if lies_on_crease(ahead) {
                regions.at_rim[here] = sides[0];
                ahead
            } else if lies_on_crease(behind) {
                regions.at_rim[behind] = sides[1];
                behind
            } else {
                break;
            };
            regions.ends[k].outward = unit(point(here) - point(to));
            regions.ends[k].position = to;
        }
    }
    let is_end =
        |position: usize| regions.at_rim[(position + len - 1) % len] != regions.at_rim[position];
    regions.ends.sort_by_key(|end| end.position);
    let mut positions = regions.ends.iter().map(|end| end.position);
    if (0..len).filter(|&i| is_end(i)).eq(positions.by_ref()) {
        Ok(())
    } else {
        let reason = "no rim edge is left to a region beside a crease";
        Err(Error::geometry(reason.to_owned()))
    }
}
