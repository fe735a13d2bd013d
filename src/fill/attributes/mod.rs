//! Values of the mesh's attributes on the new vertices and triangles.
//!
//! Numbers that vary over the surface are interpolated from the values round the hole, at first from rings 0
//! to [`BAND_RINGS`], and kept near the range that they have there. Normals are those of the patch. Everything
//! else (labels, flags, lists) is copied from the nearest rim vertex; a new triangle takes the attributes of
//! the nearest triangle along the rim. See `docs/methods/attributes.md`.
//!
//! Cost: O(n log n) for n new vertices, one dense system of at most `attributes.centers` unknowns,
//! and as many operations for each new vertex. Nothing for a mesh without attributes.

mod columns;
mod nearest;
mod rbf;

use super::cut::MeshPlace;
use crate::error::{Error, ErrorKind, Result};
use crate::fair::kharmonic::{extend_from_rim, extend_with_slope};
use crate::hole::Hole;
use crate::job::Job;
use crate::math::sparse::SpdSolver;
use crate::math::{Vec3, cross_normal, unit};
use crate::mesh::attributes::{Attribute, Attributes, ScalarType};
use crate::mesh::rings::Reach;
use crate::mesh::trimesh::TriMesh;
use crate::methods::method::Method;
use crate::methods::spec::{Extension, HoleReach};
use crate::methods::task::Task;
use crate::options::{FillOptions, Interpolator};
use crate::patch::PatchSurface;
use crate::surroundings::Surroundings;
use columns::{is_interpolated, normal_columns};
use nearest::{nearest_rim_faces, nearest_rim_vertices};
use rbf::{Rbf, spread_out};

/// Rings of triangles round the hole whose values count. Beyond four the values of a hole of usual size hardly
/// change the result; fewer lose the slope on noisy colors.
const BAND_RINGS: u32 = 4;
/// Least distance of the places that an interpolant passes through, in mean rim edges: two values at nearly
/// one place would ask for a slope that the surface does not have.
const CENTER_SEPARATION: f64 = 0.05;
/// How far an interpolated value may leave the range that its column has round the hole, over that range.
const RANGE_MARGIN: f64 = 0.1;
/// Differences at the rim below this, over the largest value, are rounding.
const NO_DIFFERENCE: f64 = 1e-6;

/// Attribute values of a patch.
#[derive(Clone, Debug, Default)]
pub(crate) struct CarriedAttributes {
    /// For each new vertex the mesh vertex whose attributes it copies where nothing better is known.
    pub(crate) vertex_sources: Vec<u32>,
    /// Values of the new vertices in those vertex columns, by position, that are not copied.
    pub(crate) vertex_values: Vec<(usize, Vec<f64>)>,
    /// For each new triangle the mesh triangle whose attributes it copies.
    pub(crate) face_sources: Vec<u32>,
}

impl CarriedAttributes {
    /// Appends the values for all new vertices and triangles.
    ///
    /// # Errors
    /// [`crate::ErrorKind::InvalidInput`] when a source is not an element.
    pub(crate) fn append_to(
        &self,
        vertices: &mut Attributes,
        faces: &mut Attributes,
    ) -> Result<()> {
        let computed: Vec<(String, &[f64])> = self
            .vertex_values
            .iter()
            .map(|(c, values)| (vertices.columns()[*c].name.clone(), &values[..]))
            .collect();
        let sources: Vec<usize> = self.vertex_sources.iter().map(|&v| v as usize).collect();
        vertices.append_with(&sources, |column, j| {
            match computed.iter().find(|(name, _)| *name == column.name) {
                Some((_, values)) => values[j],
                None => column.values.number(sources[j]).unwrap_or(0.0),
            }
        })?;
        if faces.is_empty() {
            // A polyline has no triangle to copy from.
            faces.append_blank(self.face_sources.len());
            return Ok(());
        }
        let sources: Vec<usize> = self.face_sources.iter().map(|&f| f as usize).collect();
        faces.append_copies(&sources)
    }
}

/// A patch that needs attributes, and how they are made.
pub(crate) struct AttributeTask<'a> {
    pub(crate) mesh: &'a TriMesh,
    pub(crate) hole: &'a Hole,
    pub(crate) place: &'a MeshPlace,
    pub(crate) surface: &'a PatchSurface,
    pub(crate) options: &'a FillOptions,
    /// What made the patch.
    pub(crate) method: Method,
    /// Asked from time to time; true stops the work.
    pub(crate) job: &'a Job<'a>,
}

impl AttributeTask<'_> {
    /// Computes the attribute values of the patch.
    ///
    /// # Errors
    /// [`ErrorKind::Cancelled`] only: an interpolant that cannot be computed gives way to a simpler one.
    pub(crate) fn carry(&self) -> Result<CarriedAttributes> {
        let (place, surface) = (self.place, self.surface);
        let columns = self.mesh.vertex_attributes().columns();
        let new_count = surface.points.len() - surface.rim_count;
        let vertex_sources = if columns.is_empty() {
            vec![0; new_count]
        } else {
            nearest_rim_vertices(place, surface, self.job)?
        };
        let face_sources = if self.mesh.face_attributes().columns().is_empty() {
            vec![0; surface.triangles.len()]
        } else {
            nearest_rim_faces(self.hole, place, surface)
        };
        let mut carried = CarriedAttributes {
            vertex_sources,
            vertex_values: Vec::new(),
            face_sources,
        };
        if columns.is_empty() || new_count == 0 {
            return Ok(carried);
        }
        let mut interpolated: Vec<usize> = (0..columns.len())
            .filter(|&c| is_interpolated(&columns[c], &self.options.attributes.filled))
            .collect();
        if let Some(axes) = normal_columns(columns, &self.options.attributes.filled) {
            let sign = self.sign_of_normals(axes);
            let normals = vertex_normals(surface);
            for (k, c) in axes.into_iter().enumerate() {
                let values = normals[surface.rim_count..].iter().map(|n| sign * n[k]);
                carried.vertex_values.push((c, values.collect()));
                interpolated.retain(|&i| i != c);
            }
        }
        let interpolator = self.interpolator();
        if interpolator == Interpolator::Nearest || interpolated.is_empty() {
            return Ok(carried);
        }
        let mut reach = Reach::rings(BAND_RINGS);
        if interpolator == Interpolator::Mls
            && let Some(extension) = self.extension()
        {
            let vicinity = (extension.reach)(self.options);
            let step = self.hole.surroundings.sampling_step();
            reach = place.reach(HoleReach::rings(BAND_RINGS).union(vicinity), step);
        }
        let (around, vertices) = place.surroundings(self.mesh, reach, self.job)?;
        let known: Vec<Channel> = interpolated
            .into_iter()
            .filter_map(|c| self.channel(c, &vertices))
            .collect();
        if !known.is_empty()
            && let Some(values) = self.interpolate(interpolator, &around, &known)?
        {
            for (channel, values) in known.iter().zip(values) {
                let values = values.into_iter().map(|v| channel.denormalized(v));
                carried
                    .vertex_values
                    .push((channel.column, values.collect()));
            }
        }
        Ok(carried)
    }

    /// 1 when the mesh's normals at the rim agree with the orientation of its triangles, and -1 when they are
    /// opposite to it.
    fn sign_of_normals(&self, axes: [usize; 3]) -> f64 {
        let columns = self.mesh.vertex_attributes().columns();
        let polygon = &self.hole.polygon;
        let mut agreement = 0.0;
        for (&i, outside) in polygon.iter().zip(&self.hole.outside_normals) {
            let vertex = self.place.rim[i as usize] as usize;
            let given = axes.map(|c| columns[c].values.number(vertex).unwrap_or(0.0));
            if let Some(outside) = outside {
                let product = outside.dot(&Vec3::from(given));
                agreement += if product.is_finite() { product } else { 0.0 };
            }
        }
        if agreement < 0.0 { -1.0 } else { 1.0 }
    }

    /// The values of a column at these vertices round the hole. `None` when one of them is not finite: it would spread over the
    /// whole patch.
    fn channel(&self, column: usize, vertices: &[u32]) -> Option<Channel> {
        let attribute = &self.mesh.vertex_attributes().columns()[column];
        let number = |&v: &u32| attribute.values.number(v as usize).unwrap_or(0.0);
        let values: Vec<f64> = vertices.iter().map(number).collect();
        values
            .iter()
            .all(|v| v.is_finite())
            .then(|| Channel::new(column, attribute, values))
    }

    /// Normalized values of each channel at the new vertices, by the interpolator that is asked for, else by
    /// the next simpler one. `None` when none of them can be computed.
    fn interpolate(
        &self,
        first: Interpolator,
        around: &Surroundings,
        channels: &[Channel],
    ) -> Result<Option<Vec<Vec<f64>>>> {
        let chain = [
            Interpolator::Mls,
            Interpolator::Rbf,
            Interpolator::Biharmonic,
            Interpolator::Harmonic,
        ];
        let start = chain.iter().position(|&i| i == first).unwrap_or(0);
        for &interpolator in &chain[start..] {
            let found = match interpolator {
                Interpolator::Mls => self.by_method(around, channels),
                Interpolator::Rbf => self.by_radial_functions(around, channels),
                Interpolator::Biharmonic => self.by_thin_plate(around, channels),
                _ => self.by_membrane(|i| channels.iter().map(|c| c.values[i]).collect()),
            };
            match found {
                Ok(values) => return Ok(Some(values)),
                Err(error) if error.kind() == ErrorKind::Cancelled => return Err(error),
                Err(_) => {}
            }
        }
        Ok(None)
    }

    /// The interpolator that is asked for; by default that of the method, if it has one.
    fn interpolator(&self) -> Interpolator {
        match self.options.attributes.interpolator {
            Interpolator::Auto if self.method.spec().extension.is_some() => Interpolator::Mls,
            Interpolator::Auto => Interpolator::Rbf,
            chosen => chosen,
        }
    }

    /// How the method extends values, or the one that [`Interpolator::Mls`] names.
    fn extension(&self) -> Option<&'static Extension> {
        let of = |method: Method| method.spec().extension.as_ref();
        of(self.method).or_else(|| of(Method::Mls))
    }

    fn by_method(&self, around: &Surroundings, channels: &[Channel]) -> Result<Vec<Vec<f64>>> {
        let extension = self
            .extension()
            .ok_or_else(|| Error::invalid("no method extends values"))?;
        let task = Task::new(self.hole, self.options, self.job);
        let known: Vec<Vec<f64>> = channels.iter().map(|c| c.values.clone()).collect();
        let new_points = &self.surface.points[self.surface.rim_count..];
        (extension.extend)(&task, around, &known, new_points)
    }

    fn by_radial_functions(
        &self,
        around: &Surroundings,
        channels: &[Channel],
    ) -> Result<Vec<Vec<f64>>> {
        let surface = self.surface;
        let points = around.points();
        let chosen = spread_out(points, self.options.attributes.centers, CENTER_SEPARATION);
        let centers: Vec<Vec3> = chosen.iter().map(|&i| points[i]).collect();
        let value = |i: usize, c: usize| channels[c].values[chosen[i]];
        let f = Rbf::through(&centers, channels.len(), value)?;
        let new_points = &surface.points[surface.rim_count..];
        let mut result = vec![Vec::with_capacity(new_points.len()); channels.len()];
        let mut at_point = vec![0.0; channels.len()];
        for p in new_points {
            self.job.tick(150)?;
            f.evaluate(p, &mut at_point);
            for (values, &value) in result.iter_mut().zip(&at_point) {
                values.push(value);
            }
        }
        // The rim of a large hole has more vertices than there are centres: what the function misses there
        // is added as a membrane, so that there is no seam.
        let mut missed = Vec::with_capacity(surface.rim_count);
        for (i, p) in self.hole.rim().iter().enumerate() {
            self.job.tick(150)?;
            f.evaluate(p, &mut at_point);
            let differences = channels.iter().zip(&at_point).map(|(c, v)| c.values[i] - v);
            missed.push(differences.collect::<Vec<f64>>());
        }
        if missed.iter().flatten().any(|d| d.abs() > NO_DIFFERENCE) {
            let corrections = self.by_membrane(|i| missed[i].clone())?;
            for (values, corrections) in result.iter_mut().zip(corrections) {
                for (value, correction) in values.iter_mut().zip(corrections) {
                    *value += correction;
                }
            }
        }
        Ok(result)
    }

    fn by_thin_plate(&self, around: &Surroundings, channels: &[Channel]) -> Result<Vec<Vec<f64>>> {
        let rim_count = self.surface.rim_count;
        let mut solver = SpdSolver::new(self.job);
        let mut result = Vec::with_capacity(channels.len());
        for three in channels.chunks(3) {
            self.job.ask()?;
            let row = |i: usize| Vec3::from_fn(|k, _| three.get(k).map_or(0.0, |c| c.values[i]));
            let at_rim: Vec<Vec3> = (0..rim_count).map(row).collect();
            let outside: Vec<Vec3> = (rim_count..around.points().len()).map(row).collect();
            let inside = extend_with_slope(self.surface, around, &at_rim, &outside, &mut solver)?;
            result.extend((0..three.len()).map(|k| inside.iter().map(|v| v[k]).collect()));
        }
        Ok(result)
    }

    /// Extends the rows that `at_rim` gives for the rim vertices.
    fn by_membrane(&self, at_rim: impl Fn(usize) -> Vec<f64>) -> Result<Vec<Vec<f64>>> {
        let rows: Vec<Vec<f64>> = (0..self.surface.rim_count).map(at_rim).collect();
        let channels = rows.first().map_or(0, Vec::len);
        let mut solver = SpdSolver::new(self.job);
        let mut result = Vec::with_capacity(channels);
        for first in (0..channels).step_by(3) {
            self.job.ask()?;
            let of_row =
                |row: &Vec<f64>| Vec3::from_fn(|k, _| row.get(first + k).copied().unwrap_or(0.0));
            let at_rim: Vec<Vec3> = rows.iter().map(of_row).collect();
            let inside = extend_from_rim(self.surface, &at_rim, &mut solver)?;
            for k in 0..3.min(channels - first) {
                // Rounding may leave the rim's range, which the membrane itself does not.
                let low = at_rim.iter().map(|v| v[k]).fold(f64::INFINITY, f64::min);
                let high = at_rim
                    .iter()
                    .map(|v| v[k])
                    .fold(f64::NEG_INFINITY, f64::max);
                result.push(inside.iter().map(|v| v[k].clamp(low, high)).collect());
            }
        }
        Ok(result)
    }
}

/// The values of one column at the rim and then round it, in units of the largest, so that no sum overflows.
struct Channel {
    column: usize,
    unit: f64,
    values: Vec<f64>,
    /// Range of the values that the patch may have.
    low: f64,
    high: f64,
    /// Largest number of the column's type.
    limit: f64,
}

impl Channel {
    fn new(column: usize, attribute: &Attribute, mut values: Vec<f64>) -> Self {
        let unit = values.iter().fold(f64::MIN_POSITIVE, |a, v| a.max(v.abs()));
        values.iter_mut().for_each(|v| *v /= unit);
        let low = values.iter().copied().fold(f64::INFINITY, f64::min);
        let high = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let margin = RANGE_MARGIN * (high - low);
        let limit = match attribute.values.scalar_type() {
            ScalarType::F32 => f64::from(f32::MAX),
            _ => f64::MAX,
        };
        Self {
            column,
            unit,
            values,
            low: low - margin,
            high: high + margin,
            limit,
        }
    }

    /// The value of the column, kept in its range.
    fn denormalized(&self, value: f64) -> f64 {
        (value.clamp(self.low, self.high) * self.unit).clamp(-self.limit, self.limit)
    }
}

/// Area-weighted unit normals of the vertices of the patch.
fn vertex_normals(surface: &PatchSurface) -> Vec<Vec3> {
    let mut sums = vec![Vec3::zeros(); surface.points.len()];
    for t in &surface.triangles {
        let [a, b, c] = t.map(|v| &surface.points[v as usize]);
        let normal = cross_normal(a, b, c);
        for &v in t {
            sums[v as usize] += normal;
        }
    }
    sums.into_iter().map(unit).collect()
}
