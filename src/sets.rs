//! Which things belong together.

/// Union-find over numbered things; each set is known by its smallest member.
#[derive(Debug, Default)]
pub(crate) struct Sets {
    parent: Vec<u32>,
}

impl Sets {
    /// `count` things, each alone.
    pub(crate) fn new(count: usize) -> Sets {
        Sets { parent: (0..count as u32).collect() }
    }

    /// A further thing, alone in its set.
    pub(crate) fn add(&mut self) -> usize {
        self.parent.push(self.parent.len() as u32);
        self.parent.len() - 1
    }

    /// The smallest member of the set with `member`.
    pub(crate) fn root(&mut self, mut member: usize) -> usize {
        while self.parent[member] as usize != member {
            self.parent[member] = self.parent[self.parent[member] as usize];
            member = self.parent[member] as usize;
        }
        member
    }

    /// Makes the sets of `a` and `b` one; false if they were.
    pub(crate) fn join(&mut self, a: usize, b: usize) -> bool {
        let (a, b) = (self.root(a), self.root(b));
        self.parent[a.max(b)] = a.min(b) as u32;
        a != b
    }

    /// The smallest member of the set with each one.
    pub(crate) fn roots(mut self) -> Vec<usize> {
        (0..self.parent.len()).map(|member| self.root(member)).collect()
    }

    /// A number 0.. for the set of each member, in order of the smallest members, and their count.
    pub(crate) fn numbers(mut self) -> (Vec<u32>, usize) {
        let mut numbers = vec![0; self.parent.len()];
        let mut count = 0;
        for member in 0..self.parent.len() {
            let root = self.root(member);
            numbers[member] = if root == member { count } else { numbers[root] };
            count += u32::from(root == member);
        }
        (numbers, count as usize)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sets_are_numbered_by_their_smallest_member() {
        let mut sets = Sets::new(4);
        assert_eq!(sets.add(), 4);
        assert!(sets.join(4, 1) && sets.join(3, 4));
        assert!(!sets.join(1, 3));
        assert_eq!(sets.root(4), 1);
        assert_eq!(sets.numbers(), (vec![0, 1, 2, 1, 1], 3));
    }
}
