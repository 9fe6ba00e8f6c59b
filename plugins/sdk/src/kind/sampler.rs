//! Where random numbers come from.

use crate::params::Fault;

/// Which number: a pure function of these three.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(C)]
pub struct SampleAt {
    /// Hash of seed and pixel.
    pub stream: u32,
    /// Index of the sample in its pixel.
    pub index: u32,
    /// How many dimensions this path has used.
    pub dimension: u32,
}

/// A source of numbers in [0, 1), the same for the same arguments on every machine.
pub trait Sampler: Send + Sync {
    /// Computes the derived fields.
    fn prepare(&mut self) {}

    /// Rules between parameters.
    ///
    /// # Errors
    /// The parameter at fault.
    fn check(&self) -> Result<(), Fault> {
        Ok(())
    }

    /// Samples per pixel.
    fn samples(&self) -> u32;

    /// The seed.
    fn seed(&self) -> u32;

    /// One number.
    fn get_1d(&self, at: SampleAt) -> f32;

    /// Two numbers that are spread over the square together.
    fn get_2d(&self, at: SampleAt) -> [f32; 2];

    /// Two such pairs, the second two dimensions on: the same numbers as two calls, perhaps sooner.
    fn get_2d_pair(&self, at: SampleAt) -> [[f32; 2]; 2] {
        let next = SampleAt { dimension: at.dimension + 2, ..at };
        [self.get_2d(at), self.get_2d(next)]
    }

    /// One number and two such pairs: the same numbers as three calls, perhaps sooner.
    fn get_1d_and_2d_pair(&self, at: SampleAt) -> (f32, [[f32; 2]; 2]) {
        let next = SampleAt { dimension: at.dimension + 1, ..at };
        (self.get_1d(at), self.get_2d_pair(next))
    }
}

impl<S: Sampler + ?Sized> Sampler for &S {
    fn samples(&self) -> u32 {
        (**self).samples()
    }
    fn seed(&self) -> u32 {
        (**self).seed()
    }
    fn get_1d(&self, at: SampleAt) -> f32 {
        (**self).get_1d(at)
    }
    fn get_2d(&self, at: SampleAt) -> [f32; 2] {
        (**self).get_2d(at)
    }
    fn get_2d_pair(&self, at: SampleAt) -> [[f32; 2]; 2] {
        (**self).get_2d_pair(at)
    }
    fn get_1d_and_2d_pair(&self, at: SampleAt) -> (f32, [[f32; 2]; 2]) {
        (**self).get_1d_and_2d_pair(at)
    }
}

/// The numbers of one path, taken in order.
#[derive(Clone, Copy)]
pub struct Samples<'a> {
    source: &'a dyn Sampler,
    at: SampleAt,
}

impl<'a> Samples<'a> {
    /// The numbers of a path from the given place on.
    pub fn new(source: &'a dyn Sampler, at: SampleAt) -> Self {
        Self { source, at }
    }

    /// The next number in [0, 1).
    pub fn next_1d(&mut self) -> f32 {
        let u = self.source.get_1d(self.at);
        self.at.dimension += 1;
        u
    }

    /// The next two numbers in [0, 1)².
    pub fn next_2d(&mut self) -> [f32; 2] {
        let u = self.source.get_2d(self.at);
        self.at.dimension += 2;
        u
    }

    /// The next number where somebody looks at it, else 0: those after it are the same either way.
    pub fn next_1d_if(&mut self, wanted: bool) -> f32 {
        if wanted {
            return self.next_1d();
        }
        self.at.dimension += 1;
        0.0
    }

    /// The next four numbers, as two calls of `next_2d` would give them.
    pub fn next_2d_pair(&mut self) -> [[f32; 2]; 2] {
        let u = self.source.get_2d_pair(self.at);
        self.at.dimension += 4;
        u
    }

    /// The next five numbers, as a call of `next_1d` and one of `next_2d_pair` would give them.
    pub fn next_1d_and_2d_pair(&mut self) -> (f32, [[f32; 2]; 2]) {
        let u = self.source.get_1d_and_2d_pair(self.at);
        self.at.dimension += 5;
        u
    }

    /// Where its numbers come from.
    pub fn source(&self) -> &'a dyn Sampler {
        self.source
    }

    /// Where it stands.
    pub fn at(&self) -> SampleAt {
        self.at
    }
}
