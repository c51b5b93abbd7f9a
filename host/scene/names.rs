//! Names of bodies.

use super::{Body, BodyId, Scene};
use crate::error::Error;
use std::collections::HashMap;

/// Most names or numbers that a message lists.
const LISTED: usize = 12;

impl Scene {
    /// Number of the one body with a name.
    ///
    /// ```
    /// # use nearmiss::{Body, Mesh, mesh::Positions, scene::Scene};
    /// # let mesh = |name| Mesh::new(name, Positions::F64(vec![[0.0; 3]; 3]), vec![[0, 1, 2]]);
    /// let mut scene = Scene::new();
    /// let arm = scene.add(Body::rigid(mesh("arm")?));
    /// assert_eq!(scene.id_of("arm")?, arm);
    /// # Ok::<(), nearmiss::Error>(())
    /// ```
    ///
    /// Cost: a pass over all names; see [`Scene::ids_of`] for several.
    ///
    /// # Errors
    /// [`Error::InvalidArgument`] if no body has that name, or several have: it lists them.
    pub fn id_of(&self, name: &str) -> Result<BodyId, Error> {
        let named: Vec<BodyId> =
            self.ids().filter(|id| self.get(*id).map(Body::name) == Some(name)).collect();
        match named[..] {
            [id] => Ok(id),
            [] => Err(self.none_of(name)),
            _ => Err(several_of(name, &named)),
        }
    }

    /// Numbers of the bodies with these names, in their order. Cost: a pass over all names.
    ///
    /// # Errors
    /// As of [`Scene::id_of`], for the first name that is not of one body.
    pub fn ids_of<'a>(&self, names: impl IntoIterator<Item = &'a str>) -> Result<Vec<BodyId>, Error> {
        let mut known: HashMap<&str, Vec<BodyId>> = HashMap::new();
        for id in self.ids() {
            known.entry(self.get(id).map_or("", Body::name)).or_default().push(id);
        }
        let of = |name| match known.get(name).map(Vec::as_slice) {
            Some([id]) => Ok(*id),
            Some(several) => Err(several_of(name, several)),
            None => Err(self.none_of(name)),
        };
        names.into_iter().map(of).collect()
    }

    fn none_of(&self, name: &str) -> Error {
        let names = self.ids().filter_map(|id| self.get(id)).map(|body| format!("{:?}", body.name()));
        let mut names: Vec<String> = names.collect();
        names.sort();
        names.dedup();
        let advice = if names.is_empty() {
            "the scene has no bodies: add some".into()
        } else {
            format!("choose one of {}", listed(&names))
        };
        Error::InvalidArgument { what: format!("no body is named {name:?}"), advice }
    }
}

fn several_of(name: &str, bodies: &[BodyId]) -> Error {
    let numbers: Vec<String> = bodies.iter().map(ToString::to_string).collect();
    Error::InvalidArgument {
        what: format!("bodies {} are all named {name:?}", listed(&numbers)),
        advice: "use a number, or give each body its own name".into(),
    }
}

/// The first of them, and the number of the others.
fn listed(of: &[String]) -> String {
    let more = of.len().saturating_sub(LISTED);
    let text = of[..of.len() - more].join(", ");
    if more == 0 { text } else { format!("{text} and {more} more") }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::{Mesh, Positions};

    fn scene(names: &[&str]) -> Scene {
        let body = |name: &&str| {
            let corners = Positions::F64(vec![[0.0; 3]; 3]);
            Body::rigid(Mesh::new(*name, corners, vec![[0, 1, 2]]).expect("a mesh"))
        };
        Scene::from(names.iter().map(body).collect::<Vec<_>>())
    }

    #[test]
    fn a_name_is_a_number_if_one_body_has_it() {
        let mut all = scene(&["base", "arm", "hand", "hand"]);
        assert_eq!(all.id_of("arm").expect("one"), BodyId(1));
        assert_eq!(all.ids_of(["arm", "base", "arm"]).expect("each"), [1, 0, 1].map(BodyId));
        let said = |all: &Scene, name: &str| {
            let [one, of_several] = [all.id_of(name).map(drop), all.ids_of(["base", name]).map(drop)]
                .map(|found| found.expect_err("refused").to_string());
            assert_eq!(one, of_several);
            one
        };
        assert_eq!(said(&all, "leg"), "no body is named \"leg\"; choose one of \"arm\", \"base\", \"hand\"");
        assert_eq!(
            said(&all, "hand"),
            "bodies 2, 3 are all named \"hand\"; use a number, or give each body its own name"
        );
        // A removed body has no name.
        all.remove(BodyId(3));
        assert_eq!(all.id_of("hand").expect("one"), BodyId(2));
        assert!(all.remove(BodyId(1)).is_some() && said(&all, "arm").starts_with("no body"));
        assert!(said(&all, "nothing").starts_with("no body is named \"nothing\""));
    }

    #[test]
    fn a_message_lists_few_of_many() {
        let names: Vec<String> = (10..30).map(|k| format!("b{k}")).collect();
        let all = scene(&names.iter().map(String::as_str).collect::<Vec<_>>());
        let text = all.id_of("c").expect_err("refused").to_string();
        assert!(text.contains("\"b10\"") && text.ends_with("\"b21\" and 8 more"), "{text}");
        let same = scene(&["x"; 20]).id_of("x").expect_err("refused").to_string();
        assert!(same.starts_with("bodies 0, 1,") && same.contains("11 and 8 more are all named"), "{same}");
        assert!(Scene::new().id_of("x").expect_err("refused").to_string().contains("no bodies"));
    }
}
