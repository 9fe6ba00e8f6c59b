//! The syntax tree: what the text says, each node with the bytes it comes from.

use std::sync::Arc;

use luxel_core::diag::Span;
use luxel_sdk::params::Unit;

/// A word with its place.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Name {
    pub(crate) text: Arc<str>,
    pub(crate) span: Span,
}

/// A string with its escapes resolved; the span includes the quotes.
pub(crate) type Quoted = Name;

/// A doc comment's line, without slashes.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Doc {
    pub(crate) text: String,
    pub(crate) span: Span,
}

/// Statements between braces.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Block {
    pub(crate) span: Span,
    pub(crate) stmts: Box<[Stmt]>,
}

/// A statement.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Stmt {
    pub(crate) span: Span,
    pub(crate) docs: Box<[Doc]>,
    /// Attributes, without the `@`; the span includes it.
    pub(crate) attrs: Box<[Name]>,
    pub(crate) node: StmtNode,
    /// It was read with a bracket where one is only likely to be meant: its value may be another.
    pub(crate) is_likely: bool,
}

impl Stmt {
    /// Whether `@off` takes the statement out of the scene.
    pub(crate) fn is_off(&self) -> bool {
        self.attrs.iter().any(|attr| &*attr.text == "off")
    }

    /// Whether it could not be read.
    pub(crate) fn is_broken(&self) -> bool {
        matches!(self.node, StmtNode::Broken { .. })
    }
}

/// What a statement is.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum StmtNode {
    Let {
        name: Name,
        ty: Option<Box<Ty>>,
        value: Expr,
    },
    Param(Arc<ParamDef>),
    Fn(Arc<FnDef>),
    For {
        index: Option<Name>,
        item: Name,
        over: Box<Expr>,
        body: Box<Block>,
    },
    If {
        arms: Box<[(Expr, Block)]>,
        otherwise: Option<Box<Block>>,
    },
    Include {
        path: Quoted,
        with: Box<[Field]>,
    },
    Import {
        path: Quoted,
        name: Name,
    },
    Use {
        name: Quoted,
        version: Option<Quoted>,
    },
    Place {
        what: Box<Expr>,
        label: Option<Quoted>,
        body: Option<Box<Block>>,
    },
    Set {
        path: Box<[Name]>,
        value: Expr,
    },
    Assert {
        cond: Expr,
        message: Quoted,
    },
    Expect(Arc<Expect>),
    Units(Box<[Field]>),
    Field(Field),
    Object(Arc<Object>),
    Call(Expr),
    /// It could not be read; the names that it may have been meant to define.
    Broken {
        defines: Box<[Name]>,
    },
}

/// `param x: length = 3 m in 1 m..=9 m`.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct ParamDef {
    pub(crate) name: Name,
    pub(crate) ty: Ty,
    pub(crate) value: Expr,
    pub(crate) range: Option<Expr>,
    pub(crate) doc: String,
}

/// `fn f(a: length) = …` or `fn f() { … }`.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct FnDef {
    pub(crate) name: Name,
    pub(crate) params: Box<[FnParam]>,
    pub(crate) body: FnBody,
}

/// `expect what (at) = value ± tolerance where { given }` or `expect what "path"`.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Expect {
    pub(crate) what: Name,
    /// What stands between round brackets, and where they stand.
    pub(crate) at: Option<(Span, Box<[Arg]>)>,
    pub(crate) path: Option<Quoted>,
    /// The value and, perhaps, its tolerance; neither where a path stands.
    pub(crate) values: Vec<Expr>,
    pub(crate) given: Box<[Field]>,
}

/// A parameter of a function.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct FnParam {
    pub(crate) name: Name,
    pub(crate) ty: Ty,
    pub(crate) default: Option<Expr>,
}

/// What a function does.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum FnBody {
    /// It gives a value.
    Value(Expr),
    /// It emits nodes.
    Template(Block),
}

/// A type's name, and whether it is a list of them.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Ty {
    pub(crate) name: Name,
    pub(crate) list: ListTy,
}

/// How many of a type.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum ListTy {
    One,
    /// `[]`
    Any,
    /// `[3]`
    Exactly(usize),
}

/// `name = value`.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Field {
    pub(crate) name: Name,
    pub(crate) value: Expr,
}

/// `category kind "label" { … }`.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Object {
    pub(crate) category: Name,
    pub(crate) kind: Option<Name>,
    pub(crate) label: Option<Quoted>,
    pub(crate) body: Block,
}

impl Object {
    /// Category, kind and label.
    pub(crate) fn head(&self) -> Span {
        let last = self.label.as_ref().or(self.kind.as_ref()).unwrap_or(&self.category);
        self.category.span.to(last.span)
    }
}

/// An expression.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Expr {
    pub(crate) span: Span,
    pub(crate) node: ExprNode,
}

/// Whether brackets are round or square: a vector or a list.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Form {
    Tuple,
    List,
}

/// What an expression is.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum ExprNode {
    /// A number as it was written, times its unit.
    Number(f64, Option<Arc<Unit>>),
    /// Literal numbers between brackets, or a table.
    Numbers {
        data: Arc<[f64]>,
        unit: Option<Arc<Unit>>,
        form: Form,
    },
    Text(Arc<str>),
    Bool(bool),
    /// Expressions between brackets; a single one between round brackets stands for itself.
    Items {
        items: Box<[Expr]>,
        unit: Option<Arc<Unit>>,
        form: Form,
    },
    /// `(x)`, perhaps with a unit.
    Paren {
        inner: Box<Expr>,
        unit: Option<Arc<Unit>>,
    },
    Comp(Box<Comp>),
    If {
        arms: Box<[(Expr, Expr)]>,
        otherwise: Box<Expr>,
    },
    Object(Arc<Object>),
    Record(Box<[Field]>),
    /// Words joined by dots.
    Path(Box<[Name]>),
    /// Operands of equal precedence, joined by operators: flat, so that long chains need no stack.
    Chain {
        first: Box<Expr>,
        rest: Box<[(Op, Span, Expr)]>,
    },
    Unary {
        op: Op,
        inner: Box<Expr>,
    },
    Call {
        callee: Box<Expr>,
        args: Box<[Arg]>,
    },
    Index {
        of: Box<Expr>,
        at: Box<Expr>,
    },
    Member {
        of: Box<Expr>,
        name: Box<Name>,
    },
    With {
        of: Box<Expr>,
        fields: Box<[Field]>,
    },
    /// It could not be read; it was told.
    Broken,
}

/// `[for i in 0..9 if c => value]`.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Comp {
    pub(crate) index: Option<Name>,
    pub(crate) item: Name,
    pub(crate) over: Expr,
    pub(crate) filter: Option<Expr>,
    pub(crate) value: Expr,
}

/// An argument of a call.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Arg {
    pub(crate) name: Option<Name>,
    pub(crate) value: Expr,
}

/// An operator.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Op {
    Or,
    And,
    Eq,
    Ne,
    Le,
    Ge,
    Lt,
    Gt,
    Range,
    RangeTo,
    Add,
    Sub,
    Mul,
    Div,
    Rem,
    Pow,
    Not,
}

impl Op {
    /// The operator of a token.
    pub(crate) fn of(token: &str) -> Self {
        match token {
            "||" => Self::Or,
            "&&" => Self::And,
            "==" => Self::Eq,
            "!=" => Self::Ne,
            "<=" => Self::Le,
            ">=" => Self::Ge,
            "<" => Self::Lt,
            ">" => Self::Gt,
            ".." => Self::Range,
            "..=" => Self::RangeTo,
            "+" => Self::Add,
            "-" => Self::Sub,
            "*" => Self::Mul,
            "/" => Self::Div,
            "%" => Self::Rem,
            "^" => Self::Pow,
            _ => Self::Not,
        }
    }

    /// The token.
    pub(crate) fn token(self) -> &'static str {
        match self {
            Self::Or => "||",
            Self::And => "&&",
            Self::Eq => "==",
            Self::Ne => "!=",
            Self::Le => "<=",
            Self::Ge => ">=",
            Self::Lt => "<",
            Self::Gt => ">",
            Self::Range => "..",
            Self::RangeTo => "..=",
            Self::Add => "+",
            Self::Sub => "-",
            Self::Mul => "*",
            Self::Div => "/",
            Self::Rem => "%",
            Self::Pow => "^",
            Self::Not => "!",
        }
    }

    /// How strongly a binary operator binds, from 0.
    pub(crate) fn strength(self) -> usize {
        match self {
            Self::Or => 0,
            Self::And => 1,
            Self::Eq | Self::Ne | Self::Le | Self::Ge | Self::Lt | Self::Gt => 2,
            Self::Range | Self::RangeTo => 3,
            Self::Add | Self::Sub => 4,
            Self::Mul | Self::Div | Self::Rem => 5,
            Self::Pow | Self::Not => 6,
        }
    }
}

/// Calls `each` on the expressions inside an expression, but not on those in objects.
pub(crate) fn children<'e>(expr: &'e Expr, each: &mut dyn FnMut(&'e Expr)) {
    match &expr.node {
        ExprNode::Items { items, .. } => items.iter().for_each(each),
        ExprNode::Paren { inner, .. } | ExprNode::Unary { inner, .. } => each(inner),
        ExprNode::Comp(comp) => {
            each(&comp.over);
            comp.filter.iter().for_each(&mut *each);
            each(&comp.value);
        }
        ExprNode::If { arms, otherwise } => {
            for (cond, value) in arms {
                each(cond);
                each(value);
            }
            each(otherwise);
        }
        ExprNode::Record(fields) => {
            for field in fields {
                each(&field.value);
            }
        }
        ExprNode::Chain { first, rest } => {
            each(first);
            for (_, _, operand) in rest {
                each(operand);
            }
        }
        ExprNode::Call { callee, args } => {
            each(callee);
            for arg in args {
                each(&arg.value);
            }
        }
        ExprNode::Index { of, at } => {
            each(of);
            each(at);
        }
        ExprNode::Member { of, .. } => each(of),
        ExprNode::With { of, fields } => {
            each(of);
            for field in fields {
                each(&field.value);
            }
        }
        _ => {}
    }
}
