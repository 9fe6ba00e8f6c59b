use super::table;
use crate::kind::Filter;

table! {
    /// A pixel filter that is nowhere negative.
    Filter => FilterTable "luxel_filter_table" {
        /// Half its width, pixels.
        fn radius(filter) -> f32 { Some(filter.radius()) }
        /// Its value at an offset from the pixel's centre.
        fn eval(filter, offset: &[f32; 2]) -> f32 { Some(filter.eval(*offset)) }
        /// An offset with density `eval`.
        fn sample(filter, u: &[f32; 2]) -> [f32; 2] { Some(filter.sample(*u)) }
    }
}
