//! Lanes: the widths of the plan.

/// Calls a function in the lanes of a width for sweeps or for gathers.
macro_rules! in_lanes {
    (sweep $lanes:expr, $function:ident::<$real:ident>($($argument:expr),* $(,)?)) => {
        match $lanes {
            1 => $function::<$real, _>($($argument),*),
            4 => $function::<$real::Pack4, _>($($argument),*),
            8 => $function::<$real::Pack8, _>($($argument),*),
            _ => $function::<$real::Pack16, _>($($argument),*),
        }
    };
    (gather $lanes:expr, $function:ident::<$real:ident>($($argument:expr),* $(,)?)) => {
        match $lanes {
            1 => $function::<$real, _>($($argument),*),
            4 => $function::<$real::Pack4, _>($($argument),*),
            _ => $function::<$real::Pack8, _>($($argument),*),
        }
    };
}
pub(in crate::engine) use in_lanes;
