//! How what is drawn on a layer moves with it, in numbers, for each of several ways to draw it.

/// The numbers of a layer.
#[derive(Clone, Debug, PartialEq)]
pub struct Measures {
    /// The name of what the flatness is that of.
    pub of: String,
    /// Each way by its name.
    pub ways: Vec<(&'static str, Figures)>,
}

/// The numbers of one way.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Figures {
    /// How equal sizes in the frame are: 1 is the same everywhere.
    pub flatness: Option<f64>,
    /// What happens while the camera moves, each by the name of the move.
    pub moves: Vec<(&'static str, Moved)>,
}

/// What happens while the camera moves.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Moved {
    /// How far what is drawn goes with the surface: 1 is all the way.
    pub coherence: Option<f64>,
    /// By how much it slides over the surface, in pixels a step.
    pub slide: Option<f64>,
    /// How much of it stays as it is, wherever it slides: 1 is all.
    pub continuity: Option<f64>,
}
