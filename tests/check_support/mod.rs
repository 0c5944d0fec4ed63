//! What `pss check` says of a scene.

use pss::prepare::{self, Options};
use pss::source::SourceMap;

/// The findings about a scene, as a terminal shows them.
pub fn findings(text: &str) -> String {
    let mut sources = SourceMap::default();
    let file = sources.add("scene.pss", None, text);
    let read = pss::lang::read(&mut sources, file, &prepare::catalog(), &[]);
    let (scene, _) = read.unwrap_or_else(|e| panic!("{e:?}"));
    let options = Options { measure_all: true, write_out: true, ..Options::default() };
    let prepared = prepare::prepare(&scene, &options).unwrap_or_else(|e| panic!("{e:?}"));
    let found = pss::check::findings(&prepared.shot, &prepared.outline);
    pss::report::text(&found, &sources, false)
}

macro_rules! finds {
    ($claim:ident: $scene:expr, $text:expr) => {
        #[test]
        fn $claim() {
            assert_eq!($crate::check_support::findings($scene).trim_end(), $text.trim());
        }
    };
    ($claim:ident: $scene:expr) => {
        finds! { $claim: $scene, "" }
    };
}
