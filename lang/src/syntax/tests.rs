//! The grammar against the pre-scan, and mistakes in bulk.

use super::parse::parse_whole;
use super::*;
use crate::Budgets;
use crate::sink::Sink;
use luxel_core::diag::SourceId;

const EXAMPLES: [&str; 3] = [
    include_str!("../../tests/scenes/cornell.scene"),
    include_str!("../../tests/scenes/glass_fog.scene"),
    include_str!("../../tests/scenes/parametric.scene"),
];

fn read(text: &str) -> (Tree, Vec<(&'static str, String)>) {
    let mut sink = Sink::new(100);
    let tree = parse(text, SourceId(0), &Budgets::default(), &mut sink);
    let place = |d: luxel_core::diag::Diagnostic| {
        let range = d.span().unwrap().range();
        (d.code, text[range].to_owned())
    };
    (tree, sink.finish().into_iter().map(place).collect())
}

#[test]
fn reading_by_statement_is_reading_the_file_whole() {
    for text in EXAMPLES {
        let mut sink = Sink::new(100);
        let whole = parse_whole(text, SourceId(0), &Budgets::default(), &mut sink).unwrap();
        let (cut, mistakes) = read(text);
        assert_eq!(mistakes, []);
        assert!(cut.stmts.len() > 10 && sink.finish().is_empty());
        assert_eq!(cut, whole);
        let mut sink = Sink::new(100);
        assert_eq!(cut, parse_by_pest(text, SourceId(0), &Budgets::default(), &mut sink));
    }
}

#[test]
fn of_many_brackets_that_never_close_each_is_told() {
    let told = |line: &dyn Fn(usize) -> String, n: usize| {
        let lines: String = (0..n).map(line).collect();
        let codes = read(&format!("scene 1\n{lines}let z = = 1\n")).1.into_iter();
        codes.map(|(code, _)| code).collect::<Vec<_>>()
    };
    let expected = |n: usize| [vec!["E0008"; n], vec!["E0013"]].concat();
    let block = |i: usize| format!("group {{\n  let v{i} = 1\n");
    let bracket = |i: usize| format!("let v{i} = max(1,\n");
    for n in [1, 8, 9, 99] {
        assert_eq!(told(&block, n), expected(n));
        assert_eq!(told(&bracket, n), expected(n));
    }
}

#[test]
fn several_mistakes_are_told_in_one_run() {
    let (_, mistakes) = read(include_str!("../../tests/scenes/bad_multi.scene"));
    let expected =
        [("E0015", "+"), ("E0013", "="), ("E0014", "0"), ("E0012", "0.3"), ("E0024", "a")];
    assert_eq!(mistakes, expected.map(|(code, text)| (code, text.to_owned())));
}

#[test]
fn a_nested_mistake_costs_no_more_than_its_text() {
    // Backtracking once cost 2^n here: n = 16 took seconds, n = 100 would outlive the machine.
    let n = 100;
    let text = format!("scene 1\nlet a = {}1 +{}", "material x { b = ".repeat(n), " }".repeat(n));
    let (send, receive) = std::sync::mpsc::channel();
    let reading = std::thread::spawn(move || {
        let mistakes = read(&text).1;
        send.send(mistakes).unwrap();
    });
    let mistakes = receive.recv_timeout(std::time::Duration::from_secs(5)).unwrap();
    reading.join().unwrap();
    assert_eq!(mistakes, [("E0015", "+".to_owned())]);
}

#[test]
fn operators_bind_as_in_mathematics_and_chains_are_flat() {
    let (tree, mistakes) = read("scene 1\nlet a = -b ^ 2 * 3 + c - d\n");
    assert_eq!(mistakes, []);
    let StmtNode::Let { value, .. } = &tree.stmts[0].node else { panic!("a let") };
    let ExprNode::Chain { first, rest } = &value.node else { panic!("a sum") };
    assert_eq!(rest.iter().map(|(op, ..)| *op).collect::<Vec<_>>(), [Op::Add, Op::Sub]);
    let ExprNode::Chain { first, .. } = &first.node else { panic!("a product") };
    let ExprNode::Unary { inner, .. } = &first.node else { panic!("a sign") };
    assert!(matches!(&inner.node, ExprNode::Chain { rest, .. } if rest[0].0 == Op::Pow));
}

#[test]
fn a_large_file_is_the_same_whoever_reads_its_parts() {
    let object = |i: usize| format!("shape sphere \"s{i}\" {{ radius = {i} cm }}\n");
    let valid: String =
        std::iter::once("scene 1\n".to_owned()).chain((0..9000).map(object)).collect();
    let budgets = Budgets::default();
    let mut sink = Sink::new(100);
    let tree = parse(&valid, SourceId(0), &budgets, &mut sink);
    assert_eq!(Some(tree), parse_whole(&valid, SourceId(0), &budgets, &mut sink));
    assert_eq!(sink.finish(), vec![]);
    // Mistakes are told in the order of the text, up to the limit.
    let faulty = valid.replace("7 cm", "7 = cm");
    let mut sink = Sink::new(5);
    parse(&faulty, SourceId(0), &budgets, &mut sink);
    let starts: Vec<usize> =
        sink.finish().iter().filter_map(|found| Some(found.span()?.range().start)).collect();
    assert!(starts.len() == 5 && starts.is_sorted(), "{starts:?}");
}
