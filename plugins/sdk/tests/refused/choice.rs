use luxel_sdk::Choice;

#[derive(Choice, Clone, Copy)]
//~ a choice needs #[repr(u32)] alone: the host writes it by index
enum WithoutRepr {
    /// Along x.
    X,
}

#[derive(Choice, Clone, Copy)]
#[repr(u32)]
enum WithoutDoc {
    /// Along x.
    X,
    //~ needs a doc comment: what a scene says by this word
    Y,
}

#[derive(Choice, Clone, Copy)]
#[repr(u32)]
enum WithNumber {
    /// Along x.
    //~ a word of a choice has no fields and no number of its own
    X = 7,
}

#[derive(Choice, Clone, Copy)]
#[repr(u32)]
enum WithField {
    /// Along x.
    //~ a word of a choice has no fields and no number of its own
    X(f32),
}

fn main() {}
