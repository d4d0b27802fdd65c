//! Light path expressions against a matcher of about 40 obvious lines, on random expressions and random paths.

use proptest::{prelude::*, strategy::ValueTree};
use tyndall::{
    light::LightId,
    lpe::{Automaton, Expr, Expression, Names, PathLayer, parse},
    medium::MediumId,
    path::{Kind, Source, Turn},
    shape::ObjectId,
};

/// A path: its turns, and where its light comes from.
type Word = (Vec<Turn>, Source);

fn names() -> Names {
    let list = |names: &[&[&str]]| names.iter().map(|n| n.iter().map(ToString::to_string).collect()).collect();
    Names {
        objects: list(&[&["wall", "paint"], &[], &["paint"]]),
        media: list(&[&["milk"], &["paint"]]),
        lights: list(&[&["lamp"], &[]]),
    }
}

/// What an event is called: the number of its letter, as the manual lists them, and its names.
fn event(word: &Word, at: usize) -> (usize, Vec<String>) {
    let (names, of) = (names(), |list: &[Vec<String>], id: u32| list[id as usize].clone());
    if at == 0 {
        return (10, Vec::new());
    }
    match word.0.get(at - 1) {
        Some(Turn::Surface { object, crossed, kind }) => {
            let kind = [Kind::Specular, Kind::Glossy, Kind::Diffuse].iter().position(|k| k == kind).unwrap();
            (kind + 3 * usize::from(*crossed), of(&names.objects, object.0))
        }
        Some(Turn::Medium(id)) => (6, of(&names.media, id.0)),
        None => match word.1 {
            Source::Light(id) => (7, of(&names.lights, id.0)),
            Source::Medium(id) => (8, of(&names.media, id.0)),
            Source::Sky(id) => (9, of(&names.lights, id.0)),
            Source::Fault => unreachable!(),
        },
    }
}

/// Where an expression can end that begins at `from`.
fn ends(expr: &Expr, word: &Word, from: usize) -> Vec<usize> {
    let mut found = match expr {
        Expr::Event(events) if from < word.0.len() + 2 => {
            let (letter, bears) = event(word, from);
            let fits = events.contain(letter, |name| bears.iter().any(|n| n == name));
            if fits { vec![from + 1] } else { Vec::new() }
        }
        Expr::Event(_) => Vec::new(),
        Expr::Sequence(parts) => parts.iter().fold(vec![from], |starts, part| after(part, word, &starts)),
        Expr::Either(parts) => parts.iter().flat_map(|part| ends(part, word, from)).collect(),
        Expr::Repeat { of, least, most } => {
            let (mut now, mut found) = (vec![from], Vec::new());
            // Longer than the path no repetition of something need be; of nothing, one more changes nothing.
            for times in 0..=most.unwrap_or(u32::MAX).min(least + word.0.len() as u32 + 3) {
                if times >= *least {
                    found.extend(&now);
                }
                now = after(of, word, &now);
            }
            found
        }
    };
    found.sort_unstable();
    found.dedup();
    found
}

fn after(expr: &Expr, word: &Word, starts: &[usize]) -> Vec<usize> {
    let mut ends: Vec<usize> = starts.iter().flat_map(|start| ends(expr, word, *start)).collect();
    ends.sort_unstable();
    ends.dedup();
    ends
}

fn matches(expr: &Expression, word: &Word) -> bool {
    expr.all.iter().all(|pattern| ends(pattern, word, 0).contains(&(word.0.len() + 2)))
}

fn layers(texts: &[String]) -> Vec<PathLayer> {
    let layer = |text: &String| PathLayer { name: text.clone(), text: text.clone(), expr: parse(text).unwrap() };
    texts.iter().map(layer).collect()
}

/// The state after some turns.
fn follow(automaton: &Automaton, turns: &[Turn]) -> u16 {
    turns.iter().fold(0, |state, turn| automaton.turn(state, *turn))
}

fn turn() -> impl Strategy<Value = Turn> {
    let kind = prop_oneof![Just(Kind::Specular), Just(Kind::Glossy), Just(Kind::Diffuse)];
    let surface = (0..3u32, any::<bool>(), kind);
    prop_oneof![
        surface.prop_map(|(object, crossed, kind)| Turn::Surface { object: ObjectId(object), crossed, kind }),
        (0..2u32).prop_map(|id| Turn::Medium(MediumId(id))),
    ]
}

fn word() -> impl Strategy<Value = Word> {
    let source = (0..3, 0..2u32).prop_map(|(kind, id)| match kind {
        0 => Source::Light(LightId(id)),
        1 => Source::Medium(MediumId(id)),
        _ => Source::Sky(LightId(id)),
    });
    (prop::collection::vec(turn(), 0..7), source)
}

/// The text of an expression of turns.
fn text() -> impl Strategy<Value = String> {
    let events = [
        "R",
        "T",
        "V",
        "S",
        "G",
        "D",
        ".",
        "<RD>",
        "<TS>",
        "<.G>",
        "<[RT]D>",
        "V'milk'",
        "'paint'",
        "<R.'wall'>",
        "[RV]",
        "[^V]",
        "[^V'milk' D]",
        "[<RS> 'paint']",
        "",
    ];
    let leaf = prop::sample::select(events.to_vec()).prop_map(String::from);
    leaf.prop_recursive(4, 24, 3, |inner| {
        let repeat = prop::sample::select(vec!["*", "+", "?", "{2}", "{1,}", "{0,2}", "{0}"]);
        prop_oneof![
            (inner.clone(), repeat).prop_map(|(of, times)| format!("({of}){times}")),
            prop::collection::vec(inner.clone(), 1..4).prop_map(|parts| parts.concat()),
            prop::collection::vec(inner, 1..3).prop_map(|parts| format!("({})", parts.join("|"))),
        ]
    })
}

fn whole() -> impl Strategy<Value = String> {
    let pattern = || {
        (text(), prop::sample::select(vec!["L", "[LOB]", "B", "O", "L'lamp'", "[^L]", "."]))
            .prop_map(|(turns, end)| format!("C{turns}{end}"))
    };
    prop::collection::vec(pattern(), 1..3).prop_map(|patterns| patterns.join(" & "))
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 400, rng_seed: prop::test_runner::RngSeed::Fixed(1), failure_persistence: None, ..ProptestConfig::default() })]

    /// Three expressions in one automaton, each true of the paths of which the matcher says so. Those that no path can fit are
    /// refused, and then the matcher finds none either.
    #[test]
    fn the_automaton_selects_what_the_matcher_selects(
        texts in prop::collection::vec(whole(), 3),
        words in prop::collection::vec(word(), 40),
    ) {
        let together = Automaton::new(&layers(&texts), &names());
        for (i, text) in texts.iter().enumerate() {
            let alone = Automaton::new(&layers(std::slice::from_ref(text)), &names());
            let expr = parse(text).unwrap();
            for word in &words {
                let expected = matches(&expr, word);
                let select = |a: &Automaton| a.selects(follow(a, &word.0), word.1);
                prop_assert_eq!(alone.as_ref().is_ok_and(|a| select(a) == 1), expected, "{} {:?}", text, word);
                if let Ok(together) = &together {
                    prop_assert_eq!(select(together) >> i & 1 == 1, expected, "{} of {:?}: {:?}", i, texts, word);
                }
            }
        }
    }

    /// Walks count many collisions at once: where they lead is where single steps lead, also in expressions that count.
    #[test]
    fn many_collisions_at_once_lead_where_each_alone_leads(
        body in text(), period in 1..5u32, before in prop::collection::vec(turn(), 0..3), times in 0..200u32,
    ) {
        let texts = [format!("C({body}|.(V{{{period}}})*)B")];
        let automaton = Automaton::new(&layers(&texts), &names()).unwrap();
        let (start, turn) = (follow(&automaton, &before), Turn::Medium(MediumId(0)));
        let alone = (0..times).fold(start, |state, _| automaton.turn(state, turn));
        prop_assert_eq!(automaton.turns(start, turn, times), alone);
    }

    #[test]
    fn no_text_makes_the_parser_panic(text in "[CRTVSGDLOB.&<>\\[\\]^*+?{}(),|0-9'a é]{0,30}") {
        if let Err(error) = parse(&text) {
            prop_assert!(error.at <= text.len() && !error.shown(&text).is_empty());
        }
    }
}

/// The layers that have names divide paths as their names say: by the number of turns, and of collisions.
#[test]
fn named_layers_count_turns_and_collisions() {
    let list = "all,emission,direct,indirect,unscattered,single,multiple,order0,order2,beyond2,surface,volume,\
                direct_surface,direct_volume,indirect_surface,indirect_volume,single_surface,single_volume,\
                multiple_surface,multiple_volume,order2_surface,order2_volume,beyond2_surface,beyond2_volume";
    let layers = tyndall::lpe::named::list(list).unwrap();
    let automaton = Automaton::new(&layers, &Names::default()).unwrap();
    let mut runner = prop::test_runner::TestRunner::deterministic();
    for _ in 0..3_000 {
        let (turns, source) = word().new_tree(&mut runner).unwrap().current();
        let (count, order) = (turns.len(), turns.iter().filter(|turn| matches!(turn, Turn::Medium(_))).count());
        let first = turns.first().map(|turn| matches!(turn, Turn::Medium(_)));
        let bits = automaton.selects(follow(&automaton, &turns), source);
        for (i, layer) in layers.iter().enumerate() {
            let (base, part) = match (layer.name.strip_suffix("_surface"), layer.name.strip_suffix("_volume")) {
                (Some(base), _) => (base, first == Some(false)),
                (_, Some(base)) => (base, first == Some(true)),
                _ => (&*layer.name, true),
            };
            let expected = part
                && match base {
                    "all" => true,
                    "emission" => count == 0,
                    "direct" => count == 1,
                    "indirect" => count > 1,
                    "unscattered" | "order0" => order == 0,
                    "single" => order == 1,
                    "multiple" => order > 1,
                    "order2" => order == 2,
                    "beyond2" => order > 2,
                    "surface" => first == Some(false),
                    "volume" => first == Some(true),
                    other => panic!("{other}"),
                };
            assert_eq!(bits >> i & 1 == 1, expected, "{}: {turns:?}", layer.name);
        }
    }
}

/// Sixty orders need as many states; a walk of a million collisions costs no more steps than that.
#[test]
fn many_orders_are_a_small_automaton() {
    let texts: Vec<String> = (0..60).map(|n| format!("C[RT]*(V[RT]*){{{n}}}[LOB]")).collect();
    let automaton = Automaton::new(&layers(&texts), &Names::default()).unwrap();
    assert!(automaton.states() <= 64, "{}", automaton.states());
    let state = automaton.turns(0, Turn::Medium(MediumId(0)), 1_000_000);
    assert_eq!(automaton.selects(state, Source::Sky(LightId(0))), 0);
}

#[test]
fn what_is_wrong_with_layers_is_said_with_the_place() {
    let build = |text: &str| Automaton::new(&layers(&[text.to_owned()]), &names()).unwrap_err().to_string();
    let message = build("CV'mlik'L");
    assert!(message.contains("'milk'") && message.contains("\n      ^"), "{message}");
    assert!(build("RL").contains("begins with C"));
    assert!(build("CV").contains("ends with L, O or B"));
    assert!(build("C(.{500}){500}L").contains("too large"));
    let list = |text: &str| tyndall::lpe::named::list(text).unwrap_err().to_string();
    for (text, says) in [
        ("dircet", "did you mean `direct`?"),
        ("banana", "known are all, emission"),
        ("CV*L", "write NAME=CV*L"),
        ("a=CL,a=CB", "two layers"),
        ("orders:999", "0 to 64"),
        ("depths:-1", "depths:N has N from 0 to 64"),
        ("depth0_volume", "not divided"),
        ("emission_volume", "not divided"),
        ("stderr=CL", "cannot be called"),
        ("a b=CL", "cannot be called"),
        ("single@milk", "no name in quotes"),
        ("dircet@'milk'", "did you mean `direct`?"),
        ("single@X'milk'", "`X` is not an event"),
        ("x=CXL", "layer `x`: `X` is not an event\n    CXL\n     ^"),
    ] {
        assert!(list(text).contains(says), "{text}: {}", list(text));
    }
    let named = tyndall::lpe::named::list("a=CV{1,2}L'x,y', orders:1, depths:1, deeper1_volume").unwrap();
    let called: Vec<_> = named.iter().map(|layer| &*layer.name).collect();
    assert_eq!(called, ["a", "order0", "order1", "beyond1", "depth0", "depth1", "deeper1", "deeper1_volume"]);
    let texts: Vec<_> = named[4..].iter().map(|layer| &*layer.text).collect();
    assert_eq!(texts, ["C[LOB]", "C.{1}[LOB]", "C.{2,}[LOB]", "CV.{1,}[LOB]"]);
}

/// Layers crossed with names: of the layer's paths those that have an event of that name. One of them (collisions in milk of
/// paths without collisions) is empty.
#[test]
fn layers_are_crossed_with_names() {
    let layers = tyndall::lpe::named::list("direct@L'lamp', orders:1@V'milk', all@'wall'").unwrap();
    let called: Vec<_> = layers.iter().map(|layer| &*layer.name).collect();
    assert_eq!(called, ["direct_lamp", "order0_milk", "order1_milk", "beyond1_milk", "all_wall"]);
    let automaton = Automaton::new(&layers, &names()).unwrap();
    let [milk, paint] = [0, 1].map(|id| Turn::Medium(MediumId(id)));
    let [wall, other] = [0, 1].map(|id| Turn::Surface { object: ObjectId(id), crossed: false, kind: Kind::Diffuse });
    let [lamp, dark] = [0, 1].map(|id| Source::Light(LightId(id)));
    for (turns, source, expected) in [
        (vec![milk], lamp, 0b0_0101),
        (vec![milk], dark, 0b0_0100),
        (vec![paint], lamp, 0b0_0001),
        (vec![milk, paint], lamp, 0b0_1000),
        (vec![wall, milk], dark, 0b1_0100),
        (vec![wall], lamp, 0b1_0001),
        (vec![other, other], lamp, 0b0_0000),
    ] {
        assert_eq!(automaton.selects(follow(&automaton, &turns), source), expected, "{turns:?} {source:?}");
    }
}
