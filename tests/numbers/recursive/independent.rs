//! The same numbers by numpy and scipy.

use serde_json::{Value, json};

use super::{
    NAMES, elevator, filter_options, known_starts, place, push, recorded, tracked, tracker, with,
};

/// By numpy 2.4 and scipy 1.17 (tests/python/recursive.py): a Savitzky-Golay filter and weighted least squares of all rows at once;
/// Gauss-Legendre quadrature of the weighted signals and complex least squares; a dense filter whose Φ comes from complex steps.
#[test]
fn estimates_are_those_of_an_independent_computation() {
    let band = json!({"method": "rft", "frequency": {"band_hz": [0.1, 1.5], "step_hz": 0.04}});
    let cases: [(&str, Value, f64, [[f64; 6]; 2]); 6] = [
        ("rls", json!({"method": "rls"}), 1e-6, RLS),
        (
            "rls 0.99",
            json!({"method": "rls", "forgetting": 0.99}),
            1e-6,
            RLS_99,
        ),
        ("rft", band.clone(), 1e-6, RFT),
        // the corrections of the ends are those of a transform that forgets nothing
        (
            "rft 0.998",
            with(band, json!({"forgetting": 0.998})),
            2e-2,
            RFT_998,
        ),
        ("ekf", filter_options(), 1e-6, EKF),
        (
            "ekf 0.998",
            with(
                filter_options(),
                json!({"forgetting": 0.998, "drift": {"Ma": 0.1}}),
            ),
            1e-6,
            EKF_998,
        ),
    ];
    let plan = elevator(recorded(), known_starts());
    for (what, asked, tolerance, [values, errors]) in cases {
        let (tracker, found) = tracked(&plan, asked);
        for ((name, value), error) in NAMES.iter().zip(values).zip(errors) {
            let at = place(&tracker, name);
            let (own, bound) = (found.values[at], found.standard_errors[at]);
            println!("{what} {name}: {own} ± {bound}, {value} ± {error}");
            assert!(
                (own - value).abs() < tolerance * error,
                "{what} {name}: {own}, {value}"
            );
            assert!(
                (bound / error - 1.0).abs() < tolerance.max(1e-5),
                "{what} {name}: {bound}, {error}"
            );
        }
    }
    let mut tracker = tracker(&plan, json!({"method": "rls", "forgetting": 0.99}));
    for k in 0..400 {
        push(&mut tracker, &plan.problem.segments[0], k).expect("a sample");
    }
    let found = tracker.estimates();
    let last = plan.problem.segments[0].time[395];
    assert_eq!(
        (found.samples, found.time),
        (396, last),
        "late by half a window"
    );
    for ((name, value), error) in NAMES
        .iter()
        .zip(RLS_99_AFTER_400[0])
        .zip(RLS_99_AFTER_400[1])
    {
        let own = found.values[place(&tracker, name)];
        assert!((own - value).abs() < 1e-6 * error, "{name}: {own}, {value}");
    }
}

const RLS: [[f64; 6]; 2] = [
    [
        -0.847_834_896_039,
        0.985_708_853_133,
        -0.039_693_620_342,
        -3.394_662_171_279,
        -1.598_736_971_181,
        -4.792_211_356_779,
    ],
    [
        0.016_878_760_449,
        0.018_033_192_706,
        0.029_771_809_744,
        0.025_885_670_531,
        0.027_540_072_024,
        0.045_026_685_137,
    ],
];
const RLS_99: [[f64; 6]; 2] = [
    [
        -0.833_599_245_516,
        0.971_486_749_721,
        -0.050_570_548_182,
        -3.355_683_490_365,
        -1.596_530_269_858,
        -4.770_215_407_171,
    ],
    [
        0.029_462_404_171,
        0.025_263_765_744,
        0.035_288_002_459,
        0.043_033_750_52,
        0.037_240_127_806,
        0.051_911_212_91,
    ],
];
const RLS_99_AFTER_400: [[f64; 6]; 2] = [
    [
        -0.851_577_320_175,
        0.993_456_469_178,
        -0.026_581_518_34,
        -3.386_640_311_654,
        -1.601_866_098_546,
        -4.781_454_745_808,
    ],
    [
        0.014_751_898_773,
        0.015_678_826_439,
        0.026_861_254_179,
        0.023_870_250_532,
        0.023_621_283_281,
        0.038_873_678_507,
    ],
];
const RFT: [[f64; 6]; 2] = [
    [
        -0.850_484_052_403,
        0.981_290_809_861,
        -0.050_969_878_831,
        -3.393_759_443_836,
        -1.610_797_558_71,
        -4.814_559_361_068,
    ],
    [
        0.018_738_492_067,
        0.015_967_061_049,
        0.024_813_115_119,
        0.036_679_168_114,
        0.031_254_303_409,
        0.048_569_779_127,
    ],
];
const RFT_998: [[f64; 6]; 2] = [
    [
        -0.851_623_797_554,
        0.983_353_507_689,
        -0.047_443_507_895,
        -3.387_371_795_099,
        -1.613_122_165_386,
        -4.813_867_854_61,
    ],
    [
        0.024_063_313_437,
        0.019_427_462_333,
        0.030_970_933_154,
        0.047_630_824_451,
        0.038_454_639_687,
        0.061_303_738_74,
    ],
];
const EKF: [[f64; 6]; 2] = [
    [
        -0.851_251_897_267,
        0.982_366_888_745,
        -0.064_769_821_999,
        -3.382_378_336_987,
        -1.571_949_260_823,
        -4.784_554_889_397,
    ],
    [
        0.007_418_970_372,
        0.006_505_440_951,
        0.010_309_332_397,
        0.014_658_104_13,
        0.012_112_246_309,
        0.017_077_075_043,
    ],
];
const EKF_998: [[f64; 6]; 2] = [
    [
        -0.847_593_889_916,
        0.989_255_751_729,
        -0.046_236_048_927,
        -2.598_978_200_275,
        -1.623_840_522_712,
        -4.862_809_819_808,
    ],
    [
        0.010_950_400_574,
        0.010_533_505_568,
        0.016_995_704_565,
        0.287_049_657_756,
        0.023_177_121_145,
        0.040_166_544_962,
    ],
];
