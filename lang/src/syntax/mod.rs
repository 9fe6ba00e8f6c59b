//! Text to tree: the grammar and its second reader, the tree, and the explanation of what cannot be
//! read.

mod agree;
mod amounts;
mod around;
mod borrowed;
mod build;
mod calls;
#[cfg(any(test, feature = "fuzz"))]
pub(crate) mod check;
mod closing;
mod commas;
mod cut;
mod defined;
mod digits;
mod direct;
mod edits;
mod explain;
mod expr;
mod fault;
mod foreign;
mod gaps;
mod habits;
mod head;
mod header;
mod headless;
mod joins;
mod lex;
mod listed;
mod loops;
mod make;
mod notation;
mod number;
mod operators;
mod parse;
mod paths;
mod peers;
mod recover;
mod signs;
mod statement;
#[cfg(test)]
mod tests;
mod tree;
pub(crate) mod type_names;
mod unfinished;
mod strays;
mod unit;
mod walk;
mod weigh;
mod wrapped;

pub use agree::{Agreement, agree};
pub(crate) use cut::{Cut, Cuts, resume_limit};
pub(crate) use defined::{says_units, stray};
pub(crate) use explain::COMPARES;
pub(crate) use habits::ONE_WORD;
pub(crate) use joins::ELSE;
pub(crate) use lex::{Token, TokenKind, tokens};
pub(crate) use number::parse as parse_number;
pub(crate) use parse::{
    Tree, Turns, cut, cut_whole, joined_at, parse, parse_by_pest, parse_expr, parse_in_turns,
    read_at, read_head, read_piece,
};
pub(crate) use paths::path_around;
pub(crate) use statement::QUOTED;
pub(crate) use strays::EARLY;
pub(crate) use strays::{STRAYS_LOOKED_AT, looked_at_again};
pub(crate) use tree::{
    Arg, Block, Comp, Expect, Expr, ExprNode, Field, FnBody, FnDef, FnParam, Form, ListTy, Name,
    Object, Op, ParamDef, Stmt, StmtNode, Ty, children,
};

pub(crate) use unit::suggest_unit;
pub(crate) use walk::{each_expr, each_object};

pub(crate) use grammar::{Rule, SceneParser};

/// What pest makes of the grammar.
mod grammar {
    /// The parser that pest derives.
    #[derive(pest_derive::Parser)]
    #[grammar = "scene.pest"]
    pub(crate) struct SceneParser;
}
