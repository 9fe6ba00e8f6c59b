use luxel_sdk::Choice;

#[derive(Choice, Clone, Copy)]
enum WithoutRepr {
    /// Along x.
    X,
}

#[derive(Choice, Clone, Copy)]
#[repr(u32)]
enum WithoutDoc {
    /// Along x.
    X,
    Y,
}

#[derive(Choice, Clone, Copy)]
#[repr(u32)]
enum WithNumber {
    /// Along x.
    X = 7,
}

#[derive(Choice, Clone, Copy)]
#[repr(u32)]
enum WithField {
    /// Along x.
    X(f32),
}

fn main() {}
