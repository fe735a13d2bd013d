//! Minimum-weight triangulation of a polygon in space by dynamic programming.
//!
//! The weight of a triangulation is its largest dihedral angle, with those across the rim, and, among equal ones, its
//! area. The chord `(i, j)` cuts off the positions `i..=j`. The weight of the chord is the minimum over all apexes `k`
//! between `i` and `j`, of the weights of `(i, k)` and `(k, j)` together with the triangle `(i, k, j)`. The dihedral
//! angles of this triangle are those to the best triangles at `(i, k)` and `(k, j)`.
//!
//! Sources: Gill Barequet, Micha Sharir, "Filling gaps in the boundary of a polyhedron", Computer Aided Geometric
//! Design 12 (1995), for the recurrence; Peter Liepa, "Filling holes in meshes", Symposium on Geometry Processing
//! (2003), for the weight.
//!
//! Cost: time O(m³), with a small constant, because an apex is rejected as soon as its angles exceed the best; memory
//! 22·m² bytes. Not guaranteed: the smallest possible largest angle, since the recurrence keeps only the best triangle
//! of each chord, and a worse one may fit better to the triangle above; freedom from self-intersection.

use super::polygon::{ChordRules, FlatnessTest, HolePolygon};
use crate::error::{Error, ErrorKind, Result};
use crate::job::Job;
use crate::math::Vec3;
use std::collections::BTreeSet;

/// Upper bound on the vertices of a polygon that is searched. It takes 90 MB of tables and a few seconds.
pub(crate) const MAX_SEARCHED: usize = 2048;
/// Upper bound on the searches for a polygon in which different chords can join the same two vertices.
const MAX_SEARCHES: usize = 64;
/// The normal where no triangle is known. All comparisons with NaN are false.
const NO_NORMAL: Vec3 = Vec3::new(f64::NAN, f64::NAN, f64::NAN);
/// The measure of a chord that cannot be used.
const IMPOSSIBLE: f64 = f64::INFINITY;

/// Finds the triangulation, as triangles of positions oriented like the polygon.
///
/// # Errors
/// `Limit` for more than [`MAX_SEARCHED`] vertices; `Geometry` or `Topology` when every triangulation has a triangle
/// without area or an edge that is not allowed; `Cancelled`.
pub(super) fn search(polygon: &HolePolygon<'_>, job: &Job<'_>) -> Result<Vec<[u32; 3]>> {
    let len = polygon.len();
    if len > MAX_SEARCHED {
        let message = format!("the minimum-weight search takes {MAX_SEARCHED} vertices, not {len}");
        return Err(Error::limit(message));
    }
    let rules = ChordRules::new(polygon);
    // If two chords join the same vertices, one of them is forbidden. The choices are searched depth first.
    let mut pending = vec![BTreeSet::new()];
    let mut first_failure = None;
    for _ in 0..MAX_SEARCHES {
        let Some(dropped) = pending.pop() else { break };
        let admit = |i: usize, j: usize| !dropped.contains(&(i, j)) && rules.admit(i, j);
        match solve(polygon, &admit, job) {
            Ok(triangles) => match find_twin_chords(&rules, &triangles) {
                None => return Ok(triangles),
                Some(twins) => pending.extend(twins.map(|twin| {
                    let mut extended = dropped.clone();
                    extended.insert(twin);
                    extended
                })),
            },
            Err(error) if error.kind() == ErrorKind::Cancelled => return Err(error),
            Err(error) => first_failure = first_failure.or(Some(error)),
        }
    }
    Err(first_failure.unwrap_or_else(|| {
        let message = "no triangulation was found that joins no two vertices twice";
        Error::topology(message)
    }))
}

/// Two chords `(i, j)` with `i < j` of the triangulation that join the same two vertices.
fn find_twin_chords(rules: &ChordRules<'_>, triangles: &[[u32; 3]]) -> Option<[(usize, usize); 2]> {
    if !rules.has_repeated_vertices() {
        return None;
    }
    // Each triangle (i, k, j) belongs to the chord (i, j), except the first one, at the closing edge.
    let mut chords: Vec<_> = triangles[1..]
        .iter()
        .map(|t| (t[0] as usize, t[2] as usize))
        .filter_map(|(i, j)| Some((rules.ambiguous_pair(i, j)?, (i, j))))
        .collect();
    chords.sort_unstable();
    chords
        .windows(2)
        .find(|w| w[0].0 == w[1].0)
        .map(|w| [w[0].1, w[1].1])
}

/// The best triangles at all chords `(i, j)`, `i < j`, row by row. Row `i` starts with `(i, i + 1)`, which is an edge
/// of the polygon.
struct WeightTable {
    len: usize,
    /// Largest angle at the chord and below it, as the squared distance of the two unit normals. It increases with the
    /// angle and, unlike the cosine, is accurate for small angles.
    measure: Vec<f64>,
    area: Vec<f64>,
    normal: Vec<Vec3>,
    apex: Vec<u32>,
}

impl WeightTable {
    fn new(len: usize) -> Self {
        let cells = len * (len - 1) / 2;
        Self {
            len,
            measure: vec![IMPOSSIBLE; cells],
            area: vec![0.0; cells],
            normal: vec![NO_NORMAL; cells],
            apex: vec![0; cells],
        }
    }

    fn cell(&self, i: usize, j: usize) -> usize {
        i * (2 * self.len - i - 1) / 2 + (j - i - 1)
    }
}

/// The best triangles at the chords `(i, j)` of one `j`: a column of the table, contiguous in memory.
struct Column {
    measure: Vec<f64>,
    area: Vec<f64>,
    normal: Vec<Vec3>,
    apex: Vec<u32>,
}

/// The best triangle so far at one chord.
#[derive(Clone, Copy)]
struct Winner {
    measure: f64,
    area: f64,
    normal: Vec3,
    apex: usize,
}

/// All triangles at one chord. Apexes are numbered from the first position after `i`.
struct Candidates<'t> {
    points: &'t [Vec3],
    origin: &'t Vec3,
    end: &'t Vec3,
    chord: Vec3,
    flatness: FlatnessTest,
    /// Winners at `(i, k)` and at `(k, j)`.
    left: (&'t [f64], &'t [f64], &'t [Vec3]),
    right: (&'t [f64], &'t [f64], &'t [Vec3]),
    /// Normal of the known triangle at the chord, where that is an edge of the polygon.
    outside: Vec3,
}

fn solve(
    polygon: &HolePolygon<'_>,
    admit: &dyn Fn(usize, usize) -> bool,
    job: &Job<'_>,
) -> Result<Vec<[u32; 3]>> {
    let len = polygon.len();
    let outside = |i: usize| polygon.outside_normals[i].unwrap_or(NO_NORMAL);
    let flatness = FlatnessTest::new(polygon.points);
    let mut table = WeightTable::new(len);
    let mut column = Column {
        measure: vec![IMPOSSIBLE; len],
        area: vec![0.0; len],
        normal: vec![NO_NORMAL; len],
        apex: vec![0; len],
    };
    let mut any_barred = false;
    for j in 1..len {
        job.tick(j * j / 20)?;
        for i in (0..j).rev() {
            let row = table.cell(i, i + 1);
            let closing = i == 0 && j + 1 == len;
            let winner = if i + 1 == j {
                Some(Winner {
                    measure: 0.0,
                    area: 0.0,
                    normal: outside(i),
                    apex: i,
                })
            } else if !closing && !admit(i, j) {
                any_barred = true;
                None
            } else {
                let inner = row..row + (j - i - 1);
                let candidates = Candidates {
                    points: &polygon.points[i + 1..j],
                    origin: &polygon.points[i],
                    end: &polygon.points[j],
                    chord: polygon.points[j] - polygon.points[i],
                    flatness,
                    left: (
                        &table.measure[inner.clone()],
                        &table.area[inner.clone()],
                        &table.normal[inner.clone()],
                    ),
                    right: (
                        &column.measure[i + 1..j],
                        &column.area[i + 1..j],
                        &column.normal[i + 1..j],
                    ),
                    outside: if closing { outside(j) } else { NO_NORMAL },
                };
                // The apexes of neighboring chords are probably good, so they give a low first bound.
                let likely = [
                    column.apex[i + 1] as usize,
                    table.apex[inner.end - 1] as usize,
                ];
                candidates
                    .best(likely.map(|k| k.clamp(i + 1, j - 1) - i - 1))
                    .map(|mut winner| {
                        winner.apex += i + 1;
                        winner
                    })
            };
            let winner = winner.unwrap_or(Winner {
                measure: IMPOSSIBLE,
                area: 0.0,
                normal: NO_NORMAL,
                apex: i,
            });
            column.measure[i] = winner.measure;
            column.area[i] = winner.area;
            column.normal[i] = winner.normal;
            column.apex[i] = winner.apex as u32;
            let cell = row + (j - i - 1);
            table.measure[cell] = winner.measure;
            table.area[cell] = winner.area;
            table.normal[cell] = winner.normal;
            table.apex[cell] = winner.apex as u32;
        }
    }
    if table.measure[table.cell(0, len - 1)] == IMPOSSIBLE {
        return Err(if any_barred {
            let message = "every triangulation of the hole has an edge that already exists, \
                           or a triangle without area";
            Error::topology(message)
        } else {
            let message = "every triangulation of the hole has a triangle without area";
            Error::geometry(message)
        });
    }
    Ok(trace(&table))
}

impl Candidates<'_> {
    /// The triangle of least weight; among equal ones, that with the lowest apex.
    fn best(&self, likely: [usize; 2]) -> Option<Winner> {
        let none = Winner {
            measure: f64::MAX,
            area: f64::MAX,
            normal: NO_NORMAL,
            apex: usize::MAX,
        };
        let mut winner = none;
        for k in likely {
            if self.left.0[k].max(self.right.0[k]) <= winner.measure {
                self.consider(k, &mut winner);
            }
        }
        for (k, (left, right)) in self.left.0.iter().zip(self.right.0).enumerate() {
            if *left <= winner.measure && *right <= winner.measure {
                self.consider(k, &mut winner);
            }
        }
        (winner.apex != usize::MAX).then_some(winner)
    }

    /// Takes the triangle with apex `k` as the best one if it is better.
    #[inline(always)]
    fn consider(&self, k: usize, winner: &mut Winner) {
        let area_below = self.left.1[k] + self.right.1[k];
        let mut measure = self.left.0[k].max(self.right.0[k]);
        if measure == winner.measure && area_below > winner.area {
            return;
        }
        let apex = &self.points[k];
        let doubled = (apex - self.origin).cross(&self.chord);
        let doubled_area_sq = doubled.norm_squared();
        if self
            .flatness
            .is_flat(doubled_area_sq, [self.origin, apex, self.end])
        {
            return;
        }
        let doubled_area = doubled_area_sq.sqrt();
        let normal = doubled / doubled_area;
        for neighbor in [&self.left.2[k], &self.right.2[k], &self.outside] {
            let distance_sq = (normal - neighbor).norm_squared();
            if distance_sq > measure {
                measure = distance_sq;
            }
        }
        let area = area_below + 0.5 * doubled_area;
        let better = (measure, area, k) < (winner.measure, winner.area, winner.apex);
        if better {
            *winner = Winner {
                measure,
                area,
                normal,
                apex: k,
            };
        }
    }
}

/// Lists the triangles `(i, k, j)`, `i < k < j`, of the best triangulation, from the closing edge inward.
fn trace(table: &WeightTable) -> Vec<[u32; 3]> {
    let mut triangles = Vec::with_capacity(table.len - 2);
    let mut chords = vec![(0, table.len - 1)];
    while let Some((i, j)) = chords.pop() {
        if i + 1 < j {
            let k = table.apex[table.cell(i, j)] as usize;
            triangles.push([i as u32, k as u32, j as u32]);
            chords.push((k, j));
            chords.push((i, k));
        }
    }
    triangles
}

#[cfg(test)]
mod tests {
    use super::super::polygon::weight_of;
    use super::super::test_polygons::*;
    use super::*;
    use crate::math::{cross_normal, unit};
    use proptest::prelude::*;

    /// The recurrence as it is written in the papers: angles by `atan2`, nothing dropped early.
    fn weight_by_naive_recurrence(polygon: &HolePolygon<'_>) -> Option<(f64, f64)> {
        let (m, p) = (polygon.len(), polygon.points);
        let normal = |i: usize, k: usize, j: usize| cross_normal(&p[i], &p[k], &p[j]);
        let angle =
            |a: Vec3, b: Option<Vec3>| b.map_or(0.0, |b| a.cross(&b).norm().atan2(a.dot(&b)));
        let mut best = vec![vec![None; m]; m];
        let mut won: Vec<Vec<Option<Vec3>>> = vec![vec![None; m]; m];
        for i in 0..m - 1 {
            best[i][i + 1] = Some((0.0, 0.0));
            won[i][i + 1] = polygon.outside_normals[i];
        }
        for (i, j) in (2..m).flat_map(|gap| (0..m - gap).map(move |i| (i, i + gap))) {
            let closing = j - i == m - 1;
            for k in i + 1..j {
                let barred = !closing && (polygon.blocked)(i, j);
                let (Some(a), Some(b)) = (best[i][k], best[k][j]) else {
                    continue;
                };
                let (a, b): ((f64, f64), (f64, f64)) = (a, b);
                let n = normal(i, k, j);
                if barred || n.norm() == 0.0 {
                    continue;
                }
                let rim = if closing {
                    polygon.outside_normals[j]
                } else {
                    None
                };
                let turn = angle(n, won[i][k])
                    .max(angle(n, won[k][j]))
                    .max(angle(n, rim));
                let weight = (a.0.max(b.0).max(turn), a.1 + b.1 + 0.5 * n.norm());
                if best[i][j].is_none_or(|w| weight < w) {
                    best[i][j] = Some(weight);
                    won[i][j] = Some(unit(n));
                }
            }
        }
        best[0][m - 1]
    }

    fn all_triangulations(i: u32, j: u32) -> Vec<Vec<[u32; 3]>> {
        if i + 1 >= j {
            return vec![vec![]];
        }
        let mut found = vec![];
        for k in i + 1..j {
            for left in all_triangulations(i, k) {
                for right in all_triangulations(k, j) {
                    found.push([left.clone(), right, vec![[i, k, j]]].concat());
                }
            }
        }
        found
    }

    fn found_weight(polygon: &HolePolygon<'_>) -> (f64, f64) {
        let triangles = search(polygon, &Job::unlimited()).expect("a triangulation");
        let weight = weight_of(polygon, &triangles).expect("a disk");
        (weight.max_dihedral, weight.area)
    }

    fn same(a: (f64, f64), b: (f64, f64)) -> bool {
        let close = |a: f64, b: f64| (a - b).abs() <= 1e-9 * b.abs();
        close(a.0, b.0) && close(a.1, b.1)
    }

    proptest! {
        #[test]
        fn the_weight_is_that_of_the_naive_recurrence(rim in arbitrary_rim(3..40)) {
            let naive = weight_by_naive_recurrence(&rim.polygon()).expect("general position");
            let found = found_weight(&rim.polygon());
            prop_assert!(same(found, naive), "{found:?} {naive:?}");
        }

        #[test]
        fn blocked_chords_change_nothing_else(rim in arbitrary_rim(3..14), salt in 0_usize..1000) {
            let blocked = |i: usize, j: usize| (i * 31 + j * 17 + salt).is_multiple_of(3);
            let polygon = HolePolygon { blocked: &blocked, ..rim.polygon() };
            match weight_by_naive_recurrence(&polygon) {
                Some(naive) => prop_assert!(same(found_weight(&polygon), naive)),
                None => {
                    let error = search(&polygon, &Job::unlimited()).expect_err("the naive search fails");
                    prop_assert_eq!(error.kind(), ErrorKind::Topology);
                }
            }
        }

        #[test]
        fn no_triangulation_of_a_small_polygon_is_better_than_brute_force_knows(
            rim in arbitrary_rim(3..9),
        ) {
            let polygon = rim.polygon();
            let all = all_triangulations(0, polygon.len() as u32 - 1);
            let weights = all.iter().map(|t| weight_of(&polygon, t).expect("a triangulation"));
            let best = weights.min_by(|a, b| a.partial_cmp(b).expect("no NaN")).expect("one");
            let found = found_weight(&polygon);
            prop_assert!(found.0 >= best.max_dihedral - 1e-12);
            // In a quadrangle every chord has a single triangle below it: nothing is looked back at.
            if polygon.len() <= 4 {
                prop_assert!(same(found, (best.max_dihedral, best.area)));
            }
        }
    }

    #[test]
    fn a_known_triangle_decides_which_way_a_square_is_cut() {
        let mut rim = Rim::regular(4);
        rim.points[0].z = 0.5;
        rim.points[2].z = 0.5;
        // The known surface folds more sharply along the same diagonal.
        for flip in [false, true] {
            let diagonal = if flip { [1, 3] } else { [0, 2] };
            let p: Vec<_> = rim
                .points
                .iter()
                .map(|p| Vec3::new(p.x, p.y, 4.0 * p.z))
                .collect();
            let at = |i: usize, k: usize, j: usize| Some(unit(cross_normal(&p[i], &p[k], &p[j])));
            rim.normals = if flip {
                vec![at(0, 1, 3), at(1, 2, 3), at(1, 2, 3), at(0, 1, 3)]
            } else {
                vec![at(0, 1, 2), at(0, 1, 2), at(0, 2, 3), at(0, 2, 3)]
            };
            let triangles = search(&rim.polygon(), &Job::unlimited()).expect("two triangulations");
            assert!(
                triangles
                    .iter()
                    .all(|t| diagonal.iter().all(|d| t.contains(d))),
                "{flip}"
            );
        }
    }

    #[test]
    fn a_triangle_is_its_own_triangulation() {
        assert_eq!(
            search(&Rim::regular(3).polygon(), &Job::unlimited()),
            Ok(vec![[0, 1, 2]])
        );
    }

    #[test]
    fn collinear_runs_get_no_flat_triangles() {
        let rim = Rim::planar(&subdivided(&[[0., 0.], [4., 0.], [4., 3.], [0., 3.]], 0.5));
        let triangles = search(&rim.polygon(), &Job::unlimited()).expect("a triangulation");
        let least = triangles
            .iter()
            .map(|t| rim.area(t))
            .fold(f64::INFINITY, f64::min);
        assert!(least > 0.01, "{least}");
        assert!((rim.areas(&triangles) - 12.0).abs() < 1e-12);
    }

    #[test]
    fn all_collinear_is_a_geometry_error() {
        let line: Vec<[f64; 2]> = (0..9)
            .map(|i| [f64::from(i) * 0.1, f64::from(i) * 0.3])
            .collect();
        let error = search(&Rim::planar(&line).polygon(), &Job::unlimited()).expect_err("no area");
        assert_eq!(error.kind(), ErrorKind::Geometry);
    }

    #[test]
    fn a_non_convex_plane_polygon_does_not_fold_over() {
        let rim = Rim::planar(&subdivided(
            &[[0., 0.], [4., 0.], [4., 1.], [1., 1.], [1., 4.], [0., 4.]],
            0.25,
        ));
        for start in 0..rim.points.len() {
            let rim = rim.rotated(start);
            let triangles = search(&rim.polygon(), &Job::unlimited()).expect("a triangulation");
            assert!((rim.areas(&triangles) - 7.0).abs() < 1e-12, "{start}");
        }
    }

    #[test]
    fn no_two_vertices_are_joined_twice() {
        // A triangle inside a triangle, bridged: most triangulations join some pair twice.
        let rim = Rim::bridged_triangles();
        let triangles =
            search(&rim.polygon(), &Job::unlimited()).expect("the ring has a triangulation");
        assert!(rim.joins_no_vertices_twice(&triangles));
        assert!((rim.areas(&triangles) - rim.planar_area()).abs() < 1e-12);
        let mut with_twins = 0;
        let rules = ChordRules::new(&rim.polygon());
        for triangulation in all_triangulations(0, 7) {
            let mut last_first = triangulation;
            last_first.reverse();
            with_twins += usize::from(find_twin_chords(&rules, &last_first).is_some());
        }
        assert!(with_twins > 0, "the case does not exercise the rule");
    }

    #[test]
    fn too_large_a_polygon_is_refused_and_a_stop_is_heard() {
        let kind = |rim: Rim, stop: bool| {
            let stop = || stop;
            search(&rim.polygon(), &Job::new(&stop))
                .expect_err("")
                .kind()
        };
        assert_eq!(
            kind(Rim::regular(MAX_SEARCHED + 1), false),
            ErrorKind::Limit
        );
        assert_eq!(kind(Rim::regular(10), true), ErrorKind::Cancelled);
    }
}
