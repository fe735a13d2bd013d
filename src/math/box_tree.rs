//! A static tree of boxes, for searches by box and by distance.
//!
//! Boxes are sorted by the Morton codes of their centers and grouped by eight, level by level, into an implicit tree
//! without pointers, with 32 bytes for each box. They are stored in single precision, relative to the box of all, and
//! rounded outward. So a query never misses a box, but it may return a box whose distance is a rounding error of single
//! precision.
//!
//! Complexity: build O(n log n) in parallel; box query O(log n + hits) for boxes of the faces of a
//! surface of the usual kind, O(n) at worst. The result does not depend on the thread count.

use super::Vec3;
use super::aabb::Aabb;
use crate::error::Result;
use crate::job::Job;
use rayon::prelude::*;

/// Number of children of a node. The boxes of a node fill three cache lines, and a tree of 4 million boxes has eight
/// levels.
const FANOUT: usize = 8;
/// Number of boxes in one task of a thread. Smaller tasks are not worth it.
const GRAIN: usize = 4096;
/// Upper bound on the level of cells for sorting: boxes are first sorted into at most `8 ^ 5` cells of space.
const MOST_CELL_LEVELS: u32 = 5;

/// A box in the tree's own units.
#[derive(Clone, Copy, Debug)]
struct PackedBox {
    lo: [f32; 3],
    hi: [f32; 3],
}

impl PackedBox {
    fn center(&self) -> [f32; 3] {
        std::array::from_fn(|k| 0.5 * self.lo[k] + 0.5 * self.hi[k])
    }
}

/// Siblings in the tree, stored by coordinates so that all are compared at once.
#[derive(Clone, Copy, Debug)]
struct Siblings {
    lo: [[f32; FANOUT]; 3],
    hi: [[f32; FANOUT]; 3],
}

impl Siblings {
    /// Stores at most [`FANOUT`] boxes. Unused places have empty boxes.
    fn of(boxes: impl Iterator<Item = PackedBox>) -> Self {
        let mut siblings = Self {
            lo: [[f32::INFINITY; FANOUT]; 3],
            hi: [[f32::NEG_INFINITY; FANOUT]; 3],
        };
        for (place, b) in boxes.enumerate() {
            for k in 0..3 {
                siblings.lo[k][place] = b.lo[k];
                siblings.hi[k][place] = b.hi[k];
            }
        }
        siblings
    }

    fn union(&self) -> PackedBox {
        PackedBox {
            lo: self.lo.map(|x| x.into_iter().fold(f32::INFINITY, f32::min)),
            hi: self
                .hi
                .map(|x| x.into_iter().fold(f32::NEG_INFINITY, f32::max)),
        }
    }

    /// Which siblings overlap `query`.
    fn overlapping(&self, query: &PackedBox) -> Marks {
        let Self { lo, hi } = self;
        // Whole words without short-circuits, so that the compiler vectorizes the comparisons.
        let mut apart = [0_u32; FANOUT];
        for (place, apart) in apart.iter_mut().enumerate() {
            let is_apart = (lo[0][place] > query.hi[0])
                | (lo[1][place] > query.hi[1])
                | (lo[2][place] > query.hi[2])
                | (query.lo[0] > hi[0][place])
                | (query.lo[1] > hi[1][place])
                | (query.lo[2] > hi[2][place]);
            *apart = u32::from(!is_apart) << place;
        }
        Marks(apart.into_iter().fold(0, |marks, mark| marks | mark))
    }

    /// Squared distance of `p` from the box at `place`.
    fn distance_sq(&self, place: usize, p: &Vec3) -> f64 {
        let outside = |k: usize| {
            (f64::from(self.lo[k][place]) - p[k])
                .max(p[k] - f64::from(self.hi[k][place]))
                .max(0.0)
        };
        let d: [f64; 3] = std::array::from_fn(outside);
        d[0] * d[0] + d[1] * d[1] + d[2] * d[2]
    }
}

/// A set of siblings, with one bit for each.
#[derive(Clone, Copy, Debug)]
struct Marks(u32);

impl Iterator for Marks {
    type Item = usize;

    fn next(&mut self) -> Option<usize> {
        let lowest = self.0.trailing_zeros();
        // Clears the lowest bit.
        self.0 &= self.0.wrapping_sub(1);
        (lowest < u32::BITS).then_some(lowest as usize)
    }
}

/// The affine map from mesh coordinates to the cube of side two round the origin.
#[derive(Clone, Copy, Debug)]
struct GridFrame {
    origin: Vec3,
    scale: f64,
}

impl GridFrame {
    fn fit(bounds: &Aabb) -> Self {
        let half = bounds.hi * 0.5 - bounds.lo * 0.5;
        let extent = half.max();
        let usable = extent.is_finite() && extent.recip().is_finite() && extent > 0.0;
        let origin = bounds.lo * 0.5 + bounds.hi * 0.5;
        Self {
            origin: origin.map(|x| if x.is_finite() { x } else { 0.0 }),
            scale: if usable { extent.recip() } else { 1.0 },
        }
    }

    /// The map is monotone in each coordinate, so it never reverses an order.
    fn map(&self, p: &Vec3) -> Vec3 {
        (p - self.origin) * self.scale
    }

    fn pack(&self, b: &Aabb) -> PackedBox {
        let (lo, hi) = (self.map(&b.lo), self.map(&b.hi));
        PackedBox {
            lo: std::array::from_fn(|k| round_down(lo[k])),
            hi: std::array::from_fn(|k| -round_down(-hi[k])),
        }
    }
}

/// A single-precision number below `x` by at most three units in the last place.
///
/// There is no branch on the direction of rounding, because it cannot be predicted.
fn round_down(x: f64) -> f32 {
    let nearest = x as f32;
    let margin = nearest.abs() * f32::EPSILON + f32::MIN_POSITIVE;
    // Infinity stays unchanged.
    nearest - margin.min(f32::MAX)
}

/// Finds boxes by box and by distance.
#[derive(Clone, Debug)]
pub(crate) struct BoxTree {
    frame: GridFrame,
    /// Ids of the boxes along the Morton curve.
    order: Vec<u32>,
    /// The boxes of `order` in groups of [`FANOUT`], then the boxes of these groups, and so on up to one
    /// root.
    siblings: Vec<Siblings>,
    /// Where each level starts in `siblings`, and after the last its end.
    levels: Vec<usize>,
}

impl BoxTree {
    /// Builds the tree of `count` boxes, at most `u32::MAX`. `box_of` gets the id of a box.
    ///
    /// # Errors
    /// `Cancelled` when the job is cancelled.
    pub(crate) fn build(
        count: usize,
        box_of: impl Fn(usize) -> Aabb + Sync,
        job: &Job<'_>,
    ) -> Result<Self> {
        let box_of = |id: usize| {
            // One tick for many boxes, because threads that write to the job wait for each other.
            let is_stopped = match id.is_multiple_of(GRAIN) {
                true => job.tick(GRAIN).is_err(),
                false => job.is_stopped(),
            };
            if is_stopped {
                Aabb::empty()
            } else {
                box_of(id)
            }
        };
        let indices = || (0..count).into_par_iter().with_min_len(GRAIN);
        let bounds = indices()
            .map(&box_of)
            .reduce(Aabb::empty, |a, b| a.union(&b));
        job.ask()?;
        let frame = GridFrame::fit(&bounds);

        // Code and id share one word. So the order is unique, and sorting moves eight bytes for each box.
        let id_bits = usize::BITS - count.leading_zeros();
        let axis_bits = ((u64::BITS - id_bits) / 3).min(21);
        let (mut keys, mut unsorted) = (Vec::new(), Vec::new());
        indices()
            .map(|id| {
                let b = frame.pack(&box_of(id));
                ((morton(&b.center(), axis_bits) << id_bits) | id as u64, b)
            })
            .unzip_into_vecs(&mut keys, &mut unsorted);
        job.ask()?;
        let id_mask = (1u64 << id_bits) - 1;
        let order: Vec<u32> = sorted(keys, id_bits + 3 * axis_bits, job)?
            .par_iter()
            .with_min_len(GRAIN)
            .map(|k| (k & id_mask) as u32)
            .collect();

        let groups = count.div_ceil(FANOUT);
        let mut siblings = Vec::with_capacity(groups + groups / (FANOUT - 1) + FANOUT);
        siblings.par_extend(
            order
                .par_chunks(FANOUT)
                .with_min_len(GRAIN / FANOUT)
                .map(|ids| Siblings::of(ids.iter().map(|&id| unsorted[id as usize]))),
        );
        drop(unsorted);
        job.ask()?;
        let mut levels = vec![0, siblings.len()];
        let mut start = 0;
        while siblings.len() - start > 1 {
            let parents: Vec<Siblings> = siblings[start..]
                .par_chunks(FANOUT)
                .with_min_len(GRAIN / FANOUT)
                .map(|group| Siblings::of(group.iter().map(Siblings::union)))
                .collect();
            start = siblings.len();
            siblings.extend_from_slice(&parents);
            levels.push(siblings.len());
        }
        Ok(Self {
            frame,
            order,
            siblings,
            levels,
        })
    }

    /// Puts the ids of all boxes that overlap `query` into `found`, in ascending order; `found` is cleared
    /// first.
    ///
    /// Boxes whose distance from `query` is at most a rounding error of single precision may be included.
    pub(crate) fn overlapping(&self, query: &Aabb, found: &mut Vec<u32>) {
        self.overlapping_at_most(usize::MAX, query, found);
    }

    /// As [`overlapping`](Self::overlapping), but gives up with `false` when there are more than `limit`.
    pub(crate) fn overlapping_at_most(
        &self,
        limit: usize,
        query: &Aabb,
        found: &mut Vec<u32>,
    ) -> bool {
        found.clear();
        if let Some(root) = self.root_level() {
            self.collect(root, 0, &self.frame.pack(query), limit, found);
        }
        found.sort_unstable();
        found.len() <= limit
    }

    fn collect(
        &self,
        level: usize,
        group: usize,
        query: &PackedBox,
        limit: usize,
        found: &mut Vec<u32>,
    ) {
        for place in self.group(level, group).overlapping(query) {
            if found.len() > limit {
                return;
            }
            let child = group * FANOUT + place;
            match level {
                0 => found.extend(self.order.get(child)),
                _ if self.is_group(level - 1, child) => {
                    self.collect(level - 1, child, query, limit, found);
                }
                _ => {}
            }
        }
    }

    /// The level of the root, counted from the boxes up; `None` for an empty tree.
    fn root_level(&self) -> Option<usize> {
        (!self.order.is_empty()).then(|| self.levels.len() - 2)
    }

    fn group(&self, level: usize, group: usize) -> &Siblings {
        &self.siblings[self.levels[level] + group]
    }

    /// Whether `group` exists on the level. The last group of the level above may have unused places.
    fn is_group(&self, level: usize, group: usize) -> bool {
        self.levels[level] + group < self.levels[level + 1]
    }

    /// Calls `visit` with the id of every box that may be nearer to `p` than the best result so far, near boxes first.
    /// `visit` returns the squared distance of the best result so far; infinite when there is none.
    ///
    /// `p` must be finite.
    pub(crate) fn search_near(&self, p: &Vec3, visit: impl FnMut(u32) -> f64) {
        if let Some(root) = self.root_level() {
            let mut search = NearSearch {
                tree: self,
                p: self.frame.map(p),
                visit,
                bound: f64::INFINITY,
            };
            search.descend(root, 0);
        }
    }
}

struct NearSearch<'a, F> {
    tree: &'a BoxTree,
    /// The point in the tree's units.
    p: Vec3,
    visit: F,
    /// Squared distance of the best result so far, in the tree's units.
    bound: f64,
}

impl<F: FnMut(u32) -> f64> NearSearch<'_, F> {
    fn descend(&mut self, level: usize, group: usize) {
        let tree = self.tree;
        let siblings = tree.group(level, group);
        let is_taken = |child: usize| match level {
            0 => child < tree.order.len(),
            _ => tree.is_group(level - 1, child),
        };
        let mut near = [(0.0, 0); FANOUT];
        let mut count = 0;
        let children = group * FANOUT..(group + 1) * FANOUT;
        for (place, child) in children.enumerate().filter(|&(_, child)| is_taken(child)) {
            let distance_sq = siblings.distance_sq(place, &self.p);
            if distance_sq <= self.bound {
                near[count] = (distance_sq, child);
                count += 1;
            }
        }
        let near = &mut near[..count];
        near.sort_unstable_by(|x, y| x.0.total_cmp(&y.0).then(x.1.cmp(&y.1)));
        for &(distance_sq, child) in near.iter() {
            if distance_sq > self.bound {
                break;
            }
            match level {
                0 => {
                    let scale = tree.frame.scale;
                    self.bound = (self.visit)(tree.order[child]) * scale * scale;
                }
                _ => self.descend(level - 1, child),
            }
        }
    }
}

/// Sorts keys of `bits` bits: first into cells by their highest bits, then within each cell in parallel.
fn sorted(mut keys: Vec<u64>, bits: u32, job: &Job<'_>) -> Result<Vec<u64>> {
    if keys.len() < GRAIN {
        keys.sort_unstable();
        return Ok(keys);
    }
    // A surface meets about 4 ^ level cells, so each of these has some hundred keys.
    let cell_bits = 3 * (keys.len().ilog2() / 2 - 4).min(MOST_CELL_LEVELS);
    let cell = |key: u64| (key >> (bits - cell_bits)) as usize;
    let mut ends = vec![0_usize; 1 << cell_bits];
    for keys in keys.chunks(GRAIN) {
        job.tick(GRAIN / 8)?;
        for &key in keys {
            ends[cell(key)] += 1;
        }
    }
    let mut sum = 0;
    for end in &mut ends {
        (*end, sum) = (sum, sum + *end);
    }
    let mut sorted = vec![0; keys.len()];
    for keys in keys.chunks(GRAIN) {
        job.tick(GRAIN / 8)?;
        for &key in keys {
            let place = &mut ends[cell(key)];
            sorted[*place] = key;
            *place += 1;
        }
    }
    let mut rest = sorted.as_mut_slice();
    let mut cells = Vec::new();
    let mut start = 0;
    for end in ends {
        let (keys, later) = rest.split_at_mut(end - start);
        if keys.len() > 1 {
            cells.push(keys);
        }
        (rest, start) = (later, end);
    }
    cells.into_par_iter().try_for_each(|keys| {
        job.tick(keys.len())?;
        keys.sort_unstable();
        Ok(())
    })?;
    Ok(sorted)
}

/// Position along the Morton curve of a point of the cube of side two, with `bits` per axis.
fn morton(p: &[f32; 3], bits: u32) -> u64 {
    let cells = (1u64 << bits) as f32;
    let interleave = |x: f32| {
        // The cast saturates: points outside the cube and NaN go to a cell at its rim.
        let cell = (((x + 1.0) * 0.5 * cells) as u64).min((1 << bits) - 1);
        let mut v = cell;
        v = (v | (v << 32)) & 0x001f_0000_0000_ffff;
        v = (v | (v << 16)) & 0x001f_0000_ff00_00ff;
        v = (v | (v << 8)) & 0x100f_00f0_0f00_f00f;
        v = (v | (v << 4)) & 0x10c3_0c30_c30c_30c3;
        (v | (v << 2)) & 0x1249_2492_4924_9249
    };
    interleave(p[0]) | (interleave(p[1]) << 1) | (interleave(p[2]) << 2)
}
