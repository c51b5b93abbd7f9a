//! Problems of a file: the first ends the reading, or several are gathered.

use nearmiss::mesh::Problem;

/// Problems found so far.
pub(crate) struct Problems {
    pub found: Vec<Problem>,
    most: usize,
}

impl Problems {
    /// Room for so many problems: at least one.
    pub fn of(most: usize) -> Problems {
        Problems { found: Vec::new(), most: most.max(1) }
    }

    /// Sorts those of lines, if all have one.
    pub fn sort_by_line(&mut self) {
        let line = |problem: &Problem| match problem {
            Problem::Obj(problem) => Some(problem.line()),
            _ => None,
        };
        if self.found.iter().all(|problem| line(problem).is_some()) {
            self.found.sort_by_key(line);
        }
    }

    /// Takes a problem.
    ///
    /// # Errors
    /// The problem itself if it is the last for which there is room.
    pub fn add(&mut self, problem: impl Into<Problem>) -> Result<(), Problem> {
        let problem = problem.into();
        if self.found.len() + 1 >= self.most {
            return Err(problem);
        }
        self.found.push(problem);
        Ok(())
    }
}

/// A problem of a format that has no type for its own.
pub(crate) fn wrong(what: impl Into<String>, advice: impl Into<String>) -> Problem {
    Problem::Scene { what: what.into(), advice: advice.into() }
}
