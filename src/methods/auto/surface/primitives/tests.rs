use super::super::fixtures::{
    Parametric, cone, cylinder, deviation, plane, sampled, sphere, torus, turn,
};
use super::cone::Cone;
use super::cylinder::Cylinder;
use super::torus::Torus;
use super::*;
use nalgebra::SVector;

/// A fit, its largest distance from the clean surface, and the angle between their normals.
fn measure<const D: usize, P: Primitive<D>>(surface: Parametric, noise: f64) -> (f64, f64, f64) {
    let fit = fit::<D, P>(&sampled(surface, 11, noise)).unwrap();
    let (distance, angle) = deviation(&fit.surface, surface);
    (fit.rms, distance, angle)
}

#[test]
fn each_primitive_finds_itself_to_rounding_errors() {
    for (rms, distance, angle) in [
        measure::<5, Cylinder>(cylinder, 0.0),
        measure::<6, Cone>(cone, 0.0),
        measure::<7, Torus>(torus, 0.0),
    ] {
        let what = format!("{rms:e} {distance:e} {angle:e}");
        assert!(rms < 1e-10 && distance < 1e-9 && angle < 1e-6, "{what}");
    }
}

#[test]
fn noise_is_averaged_out() {
    for (rms, distance, _) in [
        measure::<5, Cylinder>(cylinder, 0.01),
        measure::<6, Cone>(cone, 0.01),
        measure::<7, Torus>(torus, 0.01),
    ] {
        assert!((0.003..0.008).contains(&rms), "{rms}");
        assert!(distance < 0.015, "{distance}");
    }
}

#[test]
fn the_wrong_primitive_shows_it_in_its_residual() {
    assert!(measure::<5, Cylinder>(torus, 0.0).0 > 1e-3);
    assert!(measure::<5, Cylinder>(cone, 0.0).0 > 1e-3);
    assert!(measure::<6, Cone>(torus, 0.0).0 > 1e-3);
    assert!(measure::<6, Cone>(sphere, 0.0).0 > 1e-3);
}

#[test]
fn narrow_pieces_are_enough() {
    fn narrow_cylinder(u: f64, v: f64) -> (Vec3, Vec3) {
        cylinder(0.3 * u, 0.5 * v)
    }
    fn narrow_cone(u: f64, v: f64) -> (Vec3, Vec3) {
        cone(0.3 * u, 0.5 * v)
    }
    fn narrow_torus(u: f64, v: f64) -> (Vec3, Vec3) {
        torus(0.4 * u, 0.4 * v)
    }
    for (rms, distance, _) in [
        measure::<5, Cylinder>(narrow_cylinder, 0.0),
        measure::<6, Cone>(narrow_cone, 0.0),
        measure::<7, Torus>(narrow_torus, 0.0),
    ] {
        assert!(rms < 1e-9 && distance < 1e-8, "{rms:e} {distance:e}");
    }
}

fn check_degenerate<const D: usize, P: Primitive<D>>() {
    let flat = sampled(plane, 7, 0.0);
    let line = flat[..7].to_vec();
    let doubled: Vec<Sample> = flat.iter().chain(&flat).copied().collect();
    let mut broken = flat.clone();
    broken[3].normal.z = f64::NAN;
    assert!(fit::<D, P>(&[]).is_none());
    assert!(fit::<D, P>(&flat[..D - 1]).is_none());
    assert!(fit::<D, P>(&[flat[0]; 30]).is_none());
    assert!(fit::<D, P>(&broken).is_none());
    for samples in [flat, line, doubled] {
        if let Some(fit) = fit::<D, P>(&samples) {
            assert!(fit.rms.is_finite());
            let (value, gradient) = fit.surface.value_and_gradient(&samples[0].point);
            assert!(value.is_finite() && gradient.iter().all(|x| x.is_finite()));
        }
    }
}

#[test]
fn degenerate_samples_give_finite_surfaces_or_none() {
    check_degenerate::<5, Cylinder>();
    check_degenerate::<6, Cone>();
    check_degenerate::<7, Torus>();
}

fn check_invariance<const D: usize, P: Primitive<D>>(surface: Parametric) {
    let samples = sampled(surface, 9, 0.005);
    let moved = |s: &Sample| Sample {
        point: 1e3 * (turn() * s.point),
        normal: turn() * s.normal,
    };
    let moved: Vec<Sample> = samples.iter().map(moved).collect();
    let here = fit::<D, P>(&samples).unwrap();
    let there = fit::<D, P>(&moved).unwrap();
    for (s, t) in samples.iter().zip(&moved) {
        let value = here.surface.value_and_gradient(&s.point).0;
        let other = there.surface.value_and_gradient(&t.point).0 / 1e3;
        assert!((value - other).abs() < 1e-7, "{value} {other}");
    }
}

#[test]
fn a_turn_turns_the_surface() {
    check_invariance::<5, Cylinder>(cylinder);
    check_invariance::<6, Cone>(cone);
    check_invariance::<7, Torus>(torus);
}

#[test]
fn distances_have_the_gradient_that_is_given() {
    fn check<const D: usize, P: Primitive<D>>(surface: Parametric) {
        let samples = sampled(surface, 9, 0.0);
        let surface = fit::<D, P>(&samples).unwrap().surface;
        let p = samples[40].point + 0.1 * Vec3::new(1.0, -2.0, 0.5);
        let (_, gradient) = surface.value_and_gradient(&p);
        for k in 0..3 {
            let step = Vec3::ith(k, 1e-5);
            let ahead = surface.value_and_gradient(&(p + step)).0;
            let behind = surface.value_and_gradient(&(p - step)).0;
            assert!(((ahead - behind) / 2e-5 - gradient[k]).abs() < 1e-7);
        }
    }
    check::<5, Cylinder>(cylinder);
    check::<6, Cone>(cone);
    check::<7, Torus>(torus);
}

#[test]
fn slopes_are_those_of_small_steps() {
    fn check<const D: usize, P: Primitive<D>>(surface: Parametric) {
        let samples = sampled(surface, 9, 0.01);
        let primitive = fit::<D, P>(&samples).unwrap().surface.primitive;
        let across = primitive.axis().across();
        for p in [Vec3::new(0.3, -0.2, 0.5), Vec3::new(-0.9, 0.4, -0.1)] {
            let linear = primitive.linearize(&across, &p);
            assert_eq!(
                (linear.distance, linear.normal),
                primitive.distance_and_normal(&p)
            );
            for k in 0..D {
                let mut step = SVector::<f64, D>::zeros();
                step[k] = 1e-5;
                let ahead = primitive.moved(&step).distance_and_normal(&p);
                let behind = primitive.moved(&-step).distance_and_normal(&p);
                let distance = (ahead.0 - behind.0) / 2e-5;
                let normal = (ahead.1 - behind.1) / 2e-5;
                let what = format!("{k}: {distance} {}", linear.distance_slopes[k]);
                assert!(
                    (distance - linear.distance_slopes[k]).abs() < 1e-7,
                    "{what}"
                );
                assert!(
                    (normal - linear.normal_slopes[k]).norm() < 1e-6,
                    "{k}: {normal}"
                );
            }
        }
    }
    check::<5, Cylinder>(cylinder);
    check::<6, Cone>(cone);
    check::<7, Torus>(torus);
}
