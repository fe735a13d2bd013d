//! The polygon of a hole in space, the rules for its triangulations, and their weight.

use crate::error::{Error, Result};
use crate::math::{Vec3, cross_normal, unit};

/// Upper bound on the size of a polygon; the lower bound is `1 / EXTENT_LIMIT`. Outside this range, the fourth power
/// of a length would overflow or underflow.
const EXTENT_LIMIT: f64 = 1e75;
/// A triangle is flat if its height, divided by its longest edge, is below this. The cross product of its edges then
/// has fewer than four correct digits.
const FLAT_SHARE: f64 = 1e-12;
/// Height of a triangle that rounding its coordinates can cause, divided by the largest coordinate.
const COORDINATE_ROUNDING: f64 = 4.0 * f64::EPSILON;

/// A closed polygon in space and its surroundings, in the orientation of the patch.
///
/// Edge `i` runs from position `i` to position `i + 1` (cyclically). The patch lies to its left,
/// so the known mesh triangle there, if any, runs along it from `i + 1` to `i`.
#[derive(Clone, Copy)]
pub(crate) struct HolePolygon<'a> {
    /// One point per position; the first is not repeated at the end.
    pub(crate) points: &'a [Vec3],
    /// Unit normal of the known triangle at each edge, oriented like the patch; `None` when there
    /// is no such triangle or it has no area.
    pub(crate) outside_normals: &'a [Option<Vec3>],
    /// The mesh vertex at each position. A vertex may occupy several positions (bridged islands, pinched rims). No
    /// triangle may have it twice, and no edge between two vertices may be made twice.
    pub(crate) vertex_ids: &'a [u32],
    /// Whether the chord between two positions, the lower one first, already is a mesh edge and must
    /// not be created.
    pub(crate) blocked: &'a dyn Fn(usize, usize) -> bool,
}

impl HolePolygon<'_> {
    /// Number of positions, which is the number of edges.
    pub(crate) fn len(&self) -> usize {
        self.points.len()
    }

    /// Checks the conditions that all functions of this module need.
    pub(super) fn validate(&self) -> Result<()> {
        let len = self.len();
        let invalid = |message: String| Err(Error::invalid(message));
        if len < 3 {
            return invalid(format!(
                "a hole polygon of {len} vertices cannot be triangulated"
            ));
        }
        if self.outside_normals.len() != len || self.vertex_ids.len() != len {
            return invalid(format!(
                "a hole polygon of {len} points has lists of other lengths"
            ));
        }
        if u32::try_from(len).is_err() {
            return Err(Error::limit(format!("{len} vertices in one polygon")));
        }
        for i in 0..len {
            let next = (i + 1) % len;
            if self.vertex_ids[i] == self.vertex_ids[next] {
                return invalid(format!("positions {i} and {next} are the same vertex"));
            }
            let finite = |v: &Vec3| v.iter().all(|x| x.is_finite());
            if !finite(&self.points[i]) || self.outside_normals[i].is_some_and(|n| !finite(&n)) {
                return invalid(format!("the point or normal at position {i} is not finite"));
            }
        }
        let (low, high) = bounds(self.points);
        let extent = (high - low).amax();
        if extent == 0.0 {
            return Err(Error::geometry("all vertices of the hole coincide"));
        }
        if !(1.0 / EXTENT_LIMIT..=EXTENT_LIMIT).contains(&extent) {
            return Err(Error::geometry(format!("the hole has size {extent:e}")));
        }
        if self.is_collinear() {
            let message = "all vertices of the hole lie on one line";
            return Err(Error::geometry(message));
        }
        Ok(())
    }

    fn is_collinear(&self) -> bool {
        let from = &self.points[0];
        let far = |best: Vec3, p: &Vec3| {
            let better = (p - from).norm_squared() > (best - from).norm_squared();
            if better { *p } else { best }
        };
        let to = self.points.iter().fold(*from, far);
        let flatness = FlatnessTest::new(self.points);
        let is_flat =
            |p: &Vec3| flatness.is_flat(cross_normal(from, &to, p).norm_squared(), [from, &to, p]);
        self.points.iter().all(is_flat)
    }
}

fn bounds(points: &[Vec3]) -> (Vec3, Vec3) {
    let mut low = Vec3::repeat(f64::INFINITY);
    let mut high = Vec3::repeat(f64::NEG_INFINITY);
    for p in points {
        low = low.inf(p);
        high = high.sup(p);
    }
    (low, high)
}

/// Tests whether a triangle is flat, that is, whether its normal is only rounding error.
#[derive(Clone, Copy)]
pub(super) struct FlatnessTest {
    height_floor: f64,
    /// Square of the doubled area above which no triangle of the polygon is flat.
    surely_not_flat: f64,
}

impl FlatnessTest {
    pub(super) fn new(points: &[Vec3]) -> Self {
        let (low, high) = bounds(points);
        let height_floor = COORDINATE_ROUNDING * low.amax().max(high.amax());
        let diameter = (high - low).norm();
        let doubled_area = diameter * height_floor.max(FLAT_SHARE * diameter);
        Self {
            height_floor,
            surely_not_flat: doubled_area * doubled_area,
        }
    }

    /// `doubled_area_sq` is the squared length of the cross product of two edges of `corners`.
    #[inline(always)]
    pub(super) fn is_flat(&self, doubled_area_sq: f64, corners: [&Vec3; 3]) -> bool {
        doubled_area_sq <= self.surely_not_flat && self.is_flat_closely(doubled_area_sq, corners)
    }

    #[cold]
    fn is_flat_closely(&self, doubled_area_sq: f64, [a, b, c]: [&Vec3; 3]) -> bool {
        let longest_sq = (b - a)
            .norm_squared()
            .max((c - b).norm_squared())
            .max((a - c).norm_squared());
        let longest = longest_sq.sqrt();
        doubled_area_sq.sqrt() <= longest * self.height_floor.max(FLAT_SHARE * longest)
    }
}

/// The rules that say which single chords a triangulation of a polygon may use. The caller must check that no two
/// chords join the same two vertices.
pub(super) struct ChordRules<'a> {
    polygon: HolePolygon<'a>,
    /// Whether the vertex at each position occupies another position, too.
    repeated: Vec<bool>,
    /// Polygon edges at repeated vertices as sorted vertex pairs.
    edges: Vec<(u32, u32)>,
}

impl<'a> ChordRules<'a> {
    pub(super) fn new(polygon: &HolePolygon<'a>) -> Self {
        let ids = polygon.vertex_ids;
        let mut sorted: Vec<(u32, usize)> = ids.iter().copied().zip(0..).collect();
        sorted.sort_unstable();
        let mut repeated = vec![false; ids.len()];
        for pair in sorted.windows(2) {
            if pair[0].0 == pair[1].0 {
                repeated[pair[0].1] = true;
                repeated[pair[1].1] = true;
            }
        }
        let mut rules = Self {
            polygon: *polygon,
            repeated,
            edges: Vec::new(),
        };
        let edges = (0..ids.len()).filter_map(|i| rules.ambiguous_pair(i, (i + 1) % ids.len()));
        rules.edges = edges.collect();
        rules.edges.sort_unstable();
        rules
    }

    /// Whether the chord between the positions `i` and `j`, which are not neighbors, is allowed.
    pub(super) fn admit(&self, i: usize, j: usize) -> bool {
        self.polygon.vertex_ids[i] != self.polygon.vertex_ids[j]
            && self
                .ambiguous_pair(i, j)
                .is_none_or(|pair| self.edges.binary_search(&pair).is_err())
            && !(self.polygon.blocked)(i.min(j), i.max(j))
    }

    /// Whether some vertex occupies several positions.
    pub(super) fn has_repeated_vertices(&self) -> bool {
        !self.edges.is_empty()
    }

    /// The vertices of the chord in ascending order, when other positions may join the same two.
    pub(super) fn ambiguous_pair(&self, i: usize, j: usize) -> Option<(u32, u32)> {
        let (a, b) = (self.polygon.vertex_ids[i], self.polygon.vertex_ids[j]);
        (self.repeated[i] || self.repeated[j]).then_some((a.min(b), a.max(b)))
    }
}

/// The weight that the minimum-weight triangulation minimizes, in lexicographic order.
#[derive(Clone, Copy, Debug, PartialEq, PartialOrd)]
pub(crate) struct Weight {
    /// Largest angle in radians between the normals of two triangles that share an edge, the known
    /// triangles across the polygon's edges included.
    pub(crate) max_dihedral: f64,
    /// Total area.
    pub(crate) area: f64,
}

/// The weight of a triangulation of `polygon`, whose triangles are given by positions.
///
/// # Errors
/// `Topology` when `triangles` is not a triangulation: when they do not use every edge of the
/// polygon once in its direction and every other edge once in each.
pub(crate) fn weight_of(polygon: &HolePolygon<'_>, triangles: &[[u32; 3]]) -> Result<Weight> {
    let broken = |message: String| Err(Error::topology(message));
    let len = polygon.len();
    if triangles.len() + 2 != len {
        return broken(format!(
            "{} triangles do not span {len} vertices",
            triangles.len()
        ));
    }
    if triangles.iter().flatten().any(|&i| i as usize >= len) {
        return broken("a triangle leaves the polygon".into());
    }
    let corner = |t: &[u32; 3], c: usize| &polygon.points[t[c] as usize];
    let mut area = 0.0;
    // The sides of triangles as (lower position, higher position, whether the side descends, triangle).
    let mut sides = Vec::with_capacity(3 * triangles.len());
    for (index, t) in triangles.iter().enumerate() {
        area += 0.5 * cross_normal(corner(t, 0), corner(t, 1), corner(t, 2)).norm();
        for c in 0..3 {
            let (from, to) = (t[c], t[(c + 1) % 3]);
            sides.push((from.min(to), from.max(to), from > to, index));
        }
    }
    sides.sort_unstable();

    let normal = |index: usize| {
        let t = &triangles[index];
        unit(cross_normal(corner(t, 0), corner(t, 1), corner(t, 2)))
    };
    let mut max_dihedral = 0.0_f64;
    let mut edges_met = 0;
    for side in sides.chunk_by(|a, b| (a.0, a.1) == (b.0, b.1)) {
        let (low, high) = (side[0].0 as usize, side[0].1 as usize);
        // The position where this edge of the polygon starts, and whether it descends.
        let start = if high == low + 1 {
            Some((low, false))
        } else {
            (low == 0 && high + 1 == len).then_some((high, true))
        };
        let outside = match (start, side) {
            (Some((start, backward)), [one]) if one.2 == backward => {
                edges_met += 1;
                polygon.outside_normals[start]
            }
            (None, [one, other]) if !one.2 && other.2 => Some(normal(other.3)),
            _ => return broken(format!("the edge {low}-{high} is not used as it must be")),
        };
        if let Some(outside) = outside {
            max_dihedral = max_dihedral.max(angle(&normal(side[0].3), &outside));
        }
    }
    if edges_met != len {
        return broken(format!("only {edges_met} of {len} polygon edges are used"));
    }
    Ok(Weight { max_dihedral, area })
}

/// The angle between two unit vectors, accurate near 0 and near π as well.
fn angle(a: &Vec3, b: &Vec3) -> f64 {
    2.0 * (a - b).norm().atan2((a + b).norm())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::error::ErrorKind;

    const FREE: &dyn Fn(usize, usize) -> bool = &|_, _| false;

    fn square() -> Vec<Vec3> {
        [[0., 0.], [1., 0.], [1., 1.], [0., 1.]]
            .iter()
            .map(|p| Vec3::new(p[0], p[1], 0.))
            .collect()
    }

    fn polygon<'a>(
        points: &'a [Vec3],
        normals: &'a [Option<Vec3>],
        ids: &'a [u32],
    ) -> HolePolygon<'a> {
        HolePolygon {
            points,
            outside_normals: normals,
            vertex_ids: ids,
            blocked: FREE,
        }
    }

    #[test]
    fn a_folded_square_weighs_its_area_and_its_fold() {
        let mut points = square();
        points[2].z = 1.0; // triangles 012 and 023
        let normals = [Some(Vec3::z()), None, None, None];
        let weight = weight_of(
            &polygon(&points, &normals, &[0, 1, 2, 3]),
            &[[0, 1, 2], [2, 3, 0]],
        );
        let weight = weight.expect("a triangulation");
        assert!((weight.area - 2.0_f64.sqrt()).abs() < 1e-15);
        assert!((weight.max_dihedral - 60.0_f64.to_radians()).abs() < 1e-15);
    }

    #[test]
    fn the_known_triangle_at_the_closing_edge_counts() {
        let points = square();
        let normals = [
            Some(Vec3::z()),
            Some(Vec3::z()),
            Some(Vec3::z()),
            Some(-Vec3::z()),
        ];
        let weight = weight_of(
            &polygon(&points, &normals, &[0, 1, 2, 3]),
            &[[0, 1, 2], [0, 2, 3]],
        );
        assert_eq!(
            weight.expect("a triangulation").max_dihedral,
            std::f64::consts::PI
        );
    }

    #[test]
    fn anything_but_a_triangulation_is_refused() {
        let points = square();
        let polygon = polygon(&points, &[None; 4], &[0, 1, 2, 3]);
        for wrong in [
            vec![[0, 1, 2]],
            vec![[0, 1, 2], [0, 1, 2]],
            vec![[0, 1, 2], [0, 3, 2]],
            vec![[0, 2, 1], [0, 3, 2]],
            vec![[0, 1, 2], [1, 3, 2]],
            vec![[0, 1, 2], [0, 2, 4]],
            vec![[0, 0, 0], [1, 1, 1]],
        ] {
            let error = weight_of(&polygon, &wrong).expect_err("not a triangulation");
            assert_eq!(error.kind(), ErrorKind::Topology, "{wrong:?}");
        }
    }

    #[test]
    fn broken_polygons_are_named_by_cause() {
        let points = square();
        let kind = |points: &[Vec3], ids: &[u32]| {
            polygon(points, &vec![None; points.len()], ids)
                .validate()
                .expect_err("broken")
                .kind()
        };
        assert_eq!(kind(&points[..2], &[0, 1]), ErrorKind::InvalidInput);
        assert_eq!(kind(&[], &[]), ErrorKind::InvalidInput);
        assert_eq!(kind(&points, &[0, 1, 2]), ErrorKind::InvalidInput);
        assert_eq!(kind(&points, &[0, 1, 2, 0]), ErrorKind::InvalidInput);
        assert_eq!(
            kind(&[Vec3::zeros(); 4], &[0, 1, 2, 3]),
            ErrorKind::Geometry
        );
        let huge: Vec<Vec3> = points.iter().map(|p| p * 1e200).collect();
        assert_eq!(kind(&huge, &[0, 1, 2, 3]), ErrorKind::Geometry);
        let mut nan = points.clone();
        nan[3].y = f64::NAN;
        assert_eq!(kind(&nan, &[0, 1, 2, 3]), ErrorKind::InvalidInput);
        assert!(
            polygon(&points, &[None; 4], &[0, 1, 2, 3])
                .validate()
                .is_ok()
        );
    }

    #[test]
    fn flatness_scales_with_the_triangle_and_knows_coordinate_rounding() {
        let flat = |height: f64, scale: f64, offset: f64| {
            let at = |x: f64, y: f64| Vec3::new(x, y, 0.0) * scale + Vec3::repeat(offset);
            let points = [at(0., 0.), at(1., height), at(2., 0.)];
            let doubled = cross_normal(&points[0], &points[1], &points[2]).norm_squared();
            FlatnessTest::new(&points).is_flat(doubled, [&points[0], &points[1], &points[2]])
        };
        for scale in [1e-30, 1e-6, 1.0, 1e6, 1e30] {
            assert!(flat(0.0, scale, 0.0) && flat(1e-13, scale, 0.0), "{scale}");
            assert!(!flat(1e-9, scale, 0.0), "{scale}");
        }
        assert!(flat(1e-9, 1.0, 3e6) && !flat(1e-6, 1.0, 3e6));
    }

    #[test]
    fn chords_between_the_same_vertices_as_an_edge_are_barred() {
        // A bridge 1-5 walked both ways: positions 1, 2 and 6, 7 in a ring round an island.
        let points: Vec<Vec3> = (0..8).map(|i| Vec3::new(f64::from(i), 0.0, 0.0)).collect();
        let ids = [0, 1, 5, 6, 7, 5, 1, 2];
        let polygon = polygon(&points, &[None; 8], &ids);
        let rules = ChordRules::new(&polygon);
        assert!(rules.has_repeated_vertices());
        assert!(!rules.admit(1, 6), "one vertex twice");
        assert!(!rules.admit(1, 5) && !rules.admit(2, 6), "the bridge again");
        assert!(!rules.admit(2, 4), "the island's edge again");
        assert!(rules.admit(0, 3) && rules.admit(1, 3) && rules.admit(0, 5));
    }
}
