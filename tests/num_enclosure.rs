//! Enclosures hold what they claim: values at random points, in twice the precision where rounding itself is tested.

use pss::num::enclosure::Enclosure;
use pss::num::hash::Stream;

/// A number from many scales, near special ones too.
fn number(stream: &mut Stream) -> f64 {
    const SPECIAL: [f64; 8] =
        [0.0, 1.0, -1.0, 0.5, std::f64::consts::PI, -std::f64::consts::FRAC_PI_2, 2.0, -0.0];
    let pick = stream.unit();
    let sign = if stream.unit() < 0.5 { -1.0 } else { 1.0 };
    match pick {
        p if p < 0.3 => SPECIAL[(p / 0.3 * 8.0) as usize],
        p if p < 0.5 => {
            SPECIAL[(stream.unit() * 8.0) as usize] + sign * f64::EPSILON * (stream.unit() * 8.0).floor()
        }
        p if p < 0.8 => 4.0 * stream.unit() - 2.0,
        _ => sign * 10f64.powf(16.0 * stream.unit() - 8.0),
    }
}

fn interval(stream: &mut Stream) -> Enclosure {
    let (a, b) = (number(stream), number(stream));
    if stream.unit() < 0.2 { Enclosure::point(a) } else { Enclosure::new(a.min(b), a.max(b)) }
}

/// A member, the ends more often than by chance.
fn member(e: Enclosure, stream: &mut Stream) -> f64 {
    match stream.unit() {
        p if p < 0.2 => e.lo,
        p if p < 0.4 => e.hi,
        _ => (e.lo + stream.unit() * (e.hi - e.lo)).clamp(e.lo, e.hi),
    }
}

type One = (&'static str, fn(Enclosure) -> Enclosure, fn(f64) -> f64);
type Two = (&'static str, fn(Enclosure, Enclosure) -> Enclosure, fn(f64, f64) -> f64);

#[test]
fn functions_of_members_are_members() {
    let functions: &[One] = &[
        ("negate", |a| -a, |a| -a),
        ("sqrt", Enclosure::sqrt, f64::sqrt),
        ("abs", Enclosure::abs, f64::abs),
        ("exp", Enclosure::exp, f64::exp),
        ("ln", Enclosure::ln, f64::ln),
        ("sin", Enclosure::sin, f64::sin),
        ("cos", Enclosure::cos, f64::cos),
        ("tan", Enclosure::tan, f64::tan),
        ("asin", Enclosure::asin, f64::asin),
        ("acos", Enclosure::acos, f64::acos),
        ("floor", |a| a.whole(f64::floor), f64::floor),
        ("ceil", |a| a.whole(f64::ceil), f64::ceil),
        ("round", |a| a.whole(f64::round), f64::round),
        ("square", |a| a.power(2), |a| a * a),
        ("cube", |a| a.power(3), |a| a * a * a),
        ("inverse", |a| a.power(-1), |a| 1.0 / a),
        ("seventh", |a| a.power(-7), |a| a.powi(-7)),
    ];
    let mut stream = Stream::new(1);
    for (name, enclose, value) in functions {
        for _ in 0..20_000 {
            let a = interval(&mut stream);
            let (x, e) = (member(a, &mut stream), enclose(a));
            let y = value(x);
            let defined = y.is_finite();
            assert!(!defined || e.contains(y), "{name} of {x:e} in {a:?}: {y:e} not in {e:?}");
            assert!(
                defined || e.breaks.undefined(),
                "{name} of {x:e} in {a:?} is undefined, {e:?} is not marked"
            );
        }
    }
}

#[test]
fn operations_on_members_are_members() {
    let operations: &[Two] = &[
        ("+", |a, b| a + b, |a, b| a + b),
        ("-", |a, b| a - b, |a, b| a - b),
        ("*", Enclosure::times, |a, b| a * b),
        ("/", Enclosure::over, |a, b| a / b),
        ("min", Enclosure::min, f64::min),
        ("max", Enclosure::max, f64::max),
        ("atan2", Enclosure::atan2, f64::atan2),
        ("power", Enclosure::power_of, |a, b| if a < 0.0 { f64::NAN } else { a.powf(b) }),
    ];
    let mut stream = Stream::new(2);
    for (name, enclose, value) in operations {
        for _ in 0..40_000 {
            let (a, b) = (interval(&mut stream), interval(&mut stream));
            let (x, y, e) = (member(a, &mut stream), member(b, &mut stream), enclose(a, b));
            let z = value(x, y);
            assert!(
                !z.is_finite() || e.contains(z),
                "{x:e} {name} {y:e} in {a:?}, {b:?}: {z:e} not in {e:?}"
            );
            assert!(z.is_finite() || e.breaks.undefined(), "{x:e} {name} {y:e} in {a:?}, {b:?}: not marked");
        }
    }
}

#[test]
fn rounding_is_outward() {
    // What a rounded result lost is exact in a second number (TwoSum, TwoProduct); the exact result must be inside.
    let mut stream = Stream::new(3);
    for _ in 0..100_000 {
        let (a, b) = (number(&mut stream), number(&mut stream));
        let (p, q) = (Enclosure::point(a), Enclosure::point(b));
        let sum = a + b;
        let part = sum - a;
        let lost = (a - (sum - part)) + (b - part);
        let e = p + q;
        assert!(if lost < 0.0 {
            e.lo < sum
        } else if 0.0 < lost {
            sum < e.hi
        } else {
            e.lo == sum && e.hi == sum
        });
        let product = a * b;
        let lost = a.mul_add(b, -product);
        let e = p.times(q);
        assert!(if lost < 0.0 {
            e.lo < product
        } else if 0.0 < lost {
            product < e.hi
        } else {
            e.contains(product)
        });
        assert!(e.width() <= 4.0 * f64::EPSILON * product.abs() + 1e-320, "{a:e} {b:e} {e:?}");
    }
}

#[test]
fn exact_results_of_numbers_are_numbers_and_jumps_are_told() {
    let p = Enclosure::point;
    assert_eq!(p(6.0).over(p(2.0)), p(3.0));
    assert_eq!(p(0.0).over(p(7.0)), p(0.0));
    assert_eq!(p(1.5).times(p(3.0)), p(4.5));
    assert_eq!(p(-3.0).power(3), p(-27.0));
    assert!(p(1.0).over(p(3.0)).width() > 0.0 && p(0.1).times(p(0.3)).width() > 0.0);
    // What is lost below the smallest number is lost unseen.
    assert!(p(1e-200).times(p(1e-200)).width() > 0.0);
    let jumps = Enclosure::new(0.5, 1.0).whole(f64::floor);
    assert_eq!((jumps.lo, jumps.hi), (0.0, 1.0));
    assert!(jumps.breaks.any() && !jumps.breaks.undefined());
    assert!(!Enclosure::new(0.5, 0.9).whole(f64::floor).breaks.any());
    assert!((jumps + p(1.0)).breaks.any() && jumps.times(p(2.0)).breaks.any());
}

#[test]
fn waves_reach_their_crests_only_where_they_have_them() {
    let quarter = std::f64::consts::FRAC_PI_2;
    let around = Enclosure::new(quarter - 1e-9, quarter + 1e-9);
    assert_eq!(around.sin().hi, 1.0);
    assert!(Enclosure::new(0.1, 0.2).sin().hi < 0.2 && 0.0998 < Enclosure::new(0.1, 0.2).sin().lo);
    assert_eq!((Enclosure::new(0.0, 7.0).cos().lo, Enclosure::new(0.0, 7.0).cos().hi), (-1.0, 1.0));
    assert!(
        Enclosure::new(1.0, 2.0).tan().breaks.undefined()
            && !Enclosure::new(-1.0, 1.0).tan().breaks.undefined()
    );
    assert!(Enclosure::new(-1.0, 1.0).atan2(Enclosure::new(-2.0, -1.0)).breaks.any());
    assert!(!Enclosure::new(0.5, 1.0).atan2(Enclosure::new(-2.0, -1.0)).breaks.any());
}
