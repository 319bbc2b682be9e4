//! Which file uses which: paths in code and in `use`, followed through re-exports to the file that defines the name.
//!
//! `mod child;` is no use, nor is a re-export whose name the file itself does not need.

use std::collections::{BTreeMap, BTreeSet};

use super::tokens::{Token, end_of_group, of_program};

/// One name of one file that another uses.
#[derive(Clone, PartialEq, Eq, PartialOrd, Ord, Debug)]
pub(super) struct Use {
    pub(super) from: String,
    pub(super) to: String,
    pub(super) line: usize,
    pub(super) name: String,
}

impl std::fmt::Display for Use {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Self {
            from,
            to,
            line,
            name,
        } = self;
        write!(f, "{from}:{line} uses `{name}` of {to}")
    }
}

/// From the name of the crate on.
pub(super) type Path = Vec<String>;

/// The program's files, each a module.
pub(super) struct Modules(BTreeMap<Path, Module>);

struct Module {
    file: String,
    /// Without its imports.
    tokens: Vec<Token>,
    children: BTreeSet<String>,
    imports: Vec<Import>,
}

/// What one leaf of a `use` binds.
struct Import {
    name: String,
    path: Path,
    line: usize,
    exported: bool,
}

impl Modules {
    /// Reads crates from the text of their files, beginning with the root of each: `("trimtab", "src/lib.rs")`.
    /// What no module declares, or a test alone, is not read.
    pub(super) fn read(files: &BTreeMap<String, String>, crates: &[(&str, &str)]) -> Self {
        let mut modules = BTreeMap::new();
        let mut pending: Vec<(Path, String)> = crates
            .iter()
            .map(|(name, root)| (vec![(*name).to_owned()], (*root).to_owned()))
            .collect();
        while let Some((path, file)) = pending.pop() {
            let tokens = of_program(&files[&file]);
            let children = declared(&tokens);
            for child in &children {
                pending.push((joined(&path, child), file_of(child, &file, files)));
            }
            let (tokens, imports) = parted(tokens);
            let module = Module {
                file,
                tokens,
                children,
                imports,
            };
            modules.insert(path, module);
        }
        Self(modules)
    }

    pub(super) fn files(&self) -> BTreeSet<&str> {
        self.0.values().map(|module| &*module.file).collect()
    }

    /// Everything that a file uses of another one, each at its first place.
    pub(super) fn uses(&self) -> Vec<Use> {
        let mut first = BTreeMap::new();
        for (from, path, line) in self.named() {
            if let Some((to, name)) = self.definition(&path).filter(|(to, _)| *to != from) {
                let at = first.entry((from, to, name)).or_insert(line);
                *at = line.min(*at);
            }
        }
        let uses = first.into_iter().map(|((from, to, name), line)| Use {
            from: from.to_owned(),
            to: to.to_owned(),
            line,
            name,
        });
        uses.collect()
    }

    /// Every path that a file names, as far as it is known from the root of its crate on, with file and line.
    pub(super) fn named(&self) -> impl Iterator<Item = (&str, Path, usize)> {
        self.0.iter().flat_map(|(at, module)| {
            let imports = module
                .imports
                .iter()
                .filter(|import| !import.exported || module.names(&import.name))
                .map(|import| (import.path.clone(), import.line));
            imports
                .chain(paths(&module.tokens))
                .map(|(path, line)| (&*module.file, self.rooted(at, &path), line))
        })
    }

    /// Imports of everything that a module holds: they do not say what they use.
    pub(super) fn globs(&self) -> Vec<String> {
        let mut globs = Vec::new();
        for (at, module) in &self.0 {
            for import in module.imports.iter().filter(|import| import.name == "*") {
                let (_, path) = import.path.split_last().expect("a path");
                if self.0.contains_key(&self.rooted(at, path)) {
                    globs.push(format!("{}:{}", module.file, import.line));
                }
            }
        }
        globs
    }

    /// A path as it stands in the module at `at`, from the root of its crate; as it is where it leads out of the program.
    fn rooted(&self, at: &[String], path: &[String]) -> Path {
        let module = &self.0[at];
        match path[0].as_str() {
            "crate" => [&at[..1], &path[1..]].concat(),
            "self" => self.rooted_below(at, &path[1..]),
            "super" => self.rooted_below(at, path),
            first if module.children.contains(first) => [at, path].concat(),
            first => match module.import(first) {
                Some(import) if import.path[0] != first => {
                    let import = self.rooted(at, &import.path);
                    [&import[..], &path[1..]].concat()
                }
                _ => path.to_vec(),
            },
        }
    }

    fn rooted_below(&self, at: &[String], path: &[String]) -> Path {
        let up = path.iter().take_while(|word| *word == "super").count();
        [&at[..at.len() - up], &path[up..]].concat()
    }

    /// The file that defines what a rooted path names, and the name there; none if that is a module, or outside of the
    /// program.
    fn definition(&self, path: &[String]) -> Option<(&str, String)> {
        let mut at = 1;
        let mut module = self.0.get(&path[..at])?;
        while at + 1 < path.len() && module.children.contains(&path[at]) {
            at += 1;
            module = &self.0[&path[..at]];
        }
        let name = path.get(at)?;
        match module.import(name) {
            Some(import) => {
                let target = self.rooted(&path[..at], &import.path);
                self.definition(&[&target[..], &path[at + 1..]].concat())
            }
            None if module.children.contains(name) => None,
            None => Some((&module.file, name.clone())),
        }
    }
}

impl Module {
    fn import(&self, name: &str) -> Option<&Import> {
        self.imports.iter().find(|import| import.name == name)
    }

    /// Whether the code, beside its imports and declarations, may mean what is imported under a name.
    fn names(&self, name: &str) -> bool {
        let mut before = "";
        for Token { text, .. } in &self.tokens {
            if text == name && !matches!(before, "mod" | "." | "::") {
                return true;
            }
            before = text;
        }
        false
    }
}

fn joined(path: &[String], name: &str) -> Path {
    [path, &[name.to_owned()]].concat()
}

/// Where the text of `mod child;` in a file stands.
fn file_of(child: &str, file: &str, files: &BTreeMap<String, String>) -> String {
    let (directory, name) = file.rsplit_once('/').expect("a folder");
    let directory = match name {
        "mod.rs" | "lib.rs" => directory,
        _ => file.trim_end_matches(".rs"),
    };
    let alone = format!("{directory}/{child}.rs");
    if files.contains_key(&alone) {
        return alone;
    }
    format!("{directory}/{child}/mod.rs")
}

/// The modules that a file declares, but for those within it.
fn declared(tokens: &[Token]) -> BTreeSet<String> {
    tokens
        .windows(3)
        .filter(|three| three[0].text == "mod" && three[2].text == ";")
        .map(|three| three[1].text.clone())
        .collect()
}

/// The code of a file and its imports.
fn parted(tokens: Vec<Token>) -> (Vec<Token>, Vec<Import>) {
    let (mut code, mut imports) = (Vec::<Token>::new(), Vec::new());
    let mut rest = &tokens[..];
    while let Some(token) = rest.first() {
        // `use<'a>` says what a returned type holds
        if token.text == "use" && rest.get(1).is_some_and(|next| next.text != "<") {
            let end = rest.iter().position(|token| token.text == ";");
            let end = end.expect("a use ends with a semicolon");
            let exported = code
                .last()
                .is_some_and(|l| l.text == "pub" || l.text == ")");
            leaves(&rest[1..end], &[], exported, &mut imports);
            rest = &rest[end + 1..];
        } else {
            code.push(token.clone());
            rest = &rest[1..];
        }
    }
    (code, imports)
}

/// The leaves of a `use` tree, or of several with commas between.
fn leaves(tree: &[Token], before: &[String], exported: bool, imports: &mut Vec<Import>) {
    let mut path = before.to_vec();
    let mut name = None;
    let mut at = 0;
    while at < tree.len() && tree[at].text != "," {
        match tree[at].text.as_str() {
            "::" => {}
            "as" => {
                name = Some(tree[at + 1].text.clone());
                at += 1;
            }
            "{" => {
                let end = at + end_of_group(&tree[at..]);
                leaves(&tree[at + 1..end - 1], &path, exported, imports);
                // the group has said it all
                path.clear();
                at = end - 1;
            }
            "self" if !path.is_empty() => {}
            word => path.push(word.to_owned()),
        }
        at += 1;
    }
    if let Some(last) = path.last() {
        imports.push(Import {
            name: name.unwrap_or_else(|| last.clone()),
            line: tree[at - 1].line,
            path,
            exported,
        });
    }
    if at + 1 < tree.len() {
        leaves(&tree[at + 1..], before, exported, imports);
    }
}

/// The paths of two words and more in code, each with its line.
fn paths(tokens: &[Token]) -> impl Iterator<Item = (Path, usize)> {
    let starts = (0..tokens.len()).filter(|&at| {
        let after = at.checked_sub(1).map(|before| tokens[before].text.as_str());
        tokens[at].is_word() && !matches!(after, Some("::" | "."))
    });
    starts.filter_map(|at| {
        let mut path = vec![tokens[at].text.clone()];
        let mut rest = &tokens[at + 1..];
        while let [colons, word, ..] = rest
            && colons.text == "::"
            && word.is_word()
        {
            path.push(word.text.clone());
            rest = &rest[2..];
        }
        (path.len() > 1).then_some((path, tokens[at].line))
    })
}
