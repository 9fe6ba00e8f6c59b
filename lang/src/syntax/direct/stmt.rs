//! Statements.

use std::sync::Arc;

use super::Reader;
use super::expr::Place;
use super::head::is_reserved;
use crate::syntax::make;
use crate::syntax::tree::{
    Block, Doc, Expect, Expr, ExprNode, Field, FnBody, FnDef, FnParam, Name, ParamDef, Stmt,
    StmtNode, Ty,
};
use crate::words::RESERVED;

impl Reader<'_> {
    /// A statement, and the comma or semicolon after it.
    pub(super) fn stmt(&mut self) -> Option<Stmt> {
        let start = self.cursor.at;
        let (docs, attrs) = (self.docs(), self.attributes()?);
        let node = self.node(&docs)?;
        let span = self.span(start);
        self.cursor.skip();
        let _parted = self.cursor.takes(b',') || self.cursor.takes(b';');
        Some(Stmt { span, docs, attrs, node, is_likely: false })
    }

    /// Statements between braces.
    pub(super) fn block(&mut self) -> Option<Block> {
        self.cursor.skip();
        let start = self.cursor.at;
        self.cursor.mark(b'{')?;
        self.deeper(|reader| {
            let mut stmts = vec![];
            loop {
                reader.cursor.skip();
                if reader.cursor.takes(b'}') {
                    let span = reader.span(start);
                    return Some(Block { span, stmts: stmts.into() });
                }
                stmts.push(reader.stmt()?);
            }
        })
    }

    fn docs(&mut self) -> Box<[Doc]> {
        let mut docs = vec![];
        while self.cursor.is_doc() {
            let start = self.cursor.at;
            let rest = self.cursor.rest();
            self.cursor.at += memchr::memchr(b'\n', rest).unwrap_or(rest.len());
            docs.push(make::doc(self.cursor.since(start), self.span(start)));
            self.cursor.skip();
        }
        docs.into()
    }

    fn attributes(&mut self) -> Option<Box<[Name]>> {
        let mut attrs = vec![];
        while self.cursor.peek() == Some(b'@') {
            let start = self.cursor.at;
            self.cursor.at += 1;
            (self.cursor.word()? == "off").then_some(())?;
            let text = self.words.get("off");
            attrs.push(Name { text, span: self.span(start) });
            self.cursor.skip();
        }
        Some(attrs.into())
    }

    fn node(&mut self, docs: &[Doc]) -> Option<StmtNode> {
        let start = self.cursor.at;
        let word = self.cursor.word()?;
        let end = self.cursor.at;
        if self.cursor.equals() {
            self.cursor.at = start;
            let name = self.definition()?;
            self.cursor.equals();
            return Some(StmtNode::Field(Field { name, value: self.expr(Place::Value)? }));
        }
        self.cursor.at = end;
        match word {
            "let" => self.let_stmt(),
            "param" => Some(StmtNode::Param(Arc::new(self.param(docs)?))),
            "fn" => Some(StmtNode::Fn(Arc::new(self.function()?))),
            "for" => {
                let (index, item) = self.loop_names()?;
                let over = Box::new(self.expr(Place::Cond)?);
                Some(StmtNode::For { index, item, over, body: Box::new(self.block()?) })
            }
            "if" => self.if_stmt(),
            "place" => self.place(),
            "set" => {
                let path = self.path()?;
                Some(StmtNode::Set { path, value: self.assigned()? })
            }
            "assert" => {
                let cond = self.expr(Place::Cond)?;
                self.cursor.mark(b',')?;
                Some(StmtNode::Assert { cond, message: self.string()? })
            }
            "expect" => Some(StmtNode::Expect(Arc::new(self.expectation()?))),
            "units" => Some(StmtNode::Units(self.record()?)),
            "include" | "import" | "use" => self.file(word),
            _ => {
                self.cursor.at = start;
                self.object_or_call(word)
            }
        }
    }

    /// `=` and an expression.
    fn assigned(&mut self) -> Option<Expr> {
        self.cursor.equals().then_some(())?;
        self.expr(Place::Value)
    }

    fn object_or_call(&mut self, word: &str) -> Option<StmtNode> {
        if let Some(head) = self.head() {
            return Some(StmtNode::Object(Arc::new(self.object(head)?)));
        }
        if is_reserved(word) {
            return None;
        }
        let start = self.cursor.at;
        let path = self.path()?;
        let callee = Expr { span: self.span(start), node: ExprNode::Path(path) };
        Some(StmtNode::Call(self.call(callee)?))
    }

    /// Statements that name a file or a library.
    fn file(&mut self, word: &str) -> Option<StmtNode> {
        match word {
            "include" => {
                let path = self.string()?;
                let with =
                    if self.cursor.takes_word("with") { self.record()? } else { Box::default() };
                Some(StmtNode::Include { path, with })
            }
            "import" => {
                let path = self.string()?;
                self.cursor.takes_word("as").then_some(())?;
                Some(StmtNode::Import { path, name: self.definition()? })
            }
            _ => {
                self.cursor.takes_word("plugin").then_some(())?;
                let name = self.string()?;
                let has_version = self.cursor.takes_word("version");
                let version = if has_version { Some(self.string()?) } else { None };
                Some(StmtNode::Use { name, version })
            }
        }
    }

    fn let_stmt(&mut self) -> Option<StmtNode> {
        let name = self.definition()?;
        self.cursor.skip();
        let ty = if self.cursor.takes(b':') { Some(Box::new(self.ty()?)) } else { None };
        Some(StmtNode::Let { name, ty, value: self.assigned()? })
    }

    fn param(&mut self, docs: &[Doc]) -> Option<ParamDef> {
        let name = self.definition()?;
        self.cursor.mark(b':')?;
        let ty = self.ty()?;
        let value = self.assigned()?;
        let has_range = self.cursor.takes_word("in");
        let range = if has_range { Some(self.expr(Place::Value)?) } else { None };
        Some(ParamDef { name, ty, value, range, doc: make::lines(docs) })
    }

    fn function(&mut self) -> Option<FnDef> {
        let name = self.definition()?;
        self.cursor.mark(b'(')?;
        let (params, _) = self.listed(b')', Self::fn_param)?;
        let body = if self.cursor.equals() {
            FnBody::Value(self.expr(Place::Value)?)
        } else {
            FnBody::Template(self.block()?)
        };
        Some(FnDef { name, params, body })
    }

    fn fn_param(&mut self) -> Option<FnParam> {
        let name = self.definition()?;
        self.cursor.mark(b':')?;
        let ty = self.ty()?;
        let default = if self.cursor.equals() { Some(self.expr(Place::Value)?) } else { None };
        Some(FnParam { name, ty, default })
    }

    fn ty(&mut self) -> Option<Ty> {
        self.cursor.skip();
        let start = self.cursor.at;
        self.cursor.word().filter(|word| !is_reserved(word))?;
        let end = self.cursor.at;
        if self.cursor.takes(b'[') {
            self.cursor.take_while(|byte| byte.is_ascii_digit());
            if !self.cursor.takes(b']') {
                self.cursor.at = end;
            }
        }
        Some(make::ty(self.cursor.since(start), self.span(start)))
    }

    fn if_stmt(&mut self) -> Option<StmtNode> {
        let mut arms = vec![];
        loop {
            let cond = self.expr(Place::Cond)?;
            arms.push((cond, self.block()?));
            if !self.cursor.takes_word("else") {
                return Some(StmtNode::If { arms: arms.into(), otherwise: None });
            }
            if !self.cursor.takes_word("if") {
                let otherwise = Some(Box::new(self.block()?));
                return Some(StmtNode::If { arms: arms.into(), otherwise });
            }
        }
    }

    fn place(&mut self) -> Option<StmtNode> {
        self.cursor.skip();
        let start = self.cursor.at;
        let path = self.path().filter(|path| !RESERVED.contains(&&*path[0].text))?;
        let what = Box::new(Expr { span: self.span(start), node: ExprNode::Path(path) });
        self.cursor.skip();
        let has_label = self.cursor.peek() == Some(b'"');
        let label = if has_label { Some(self.string()?) } else { None };
        self.cursor.skip();
        let has_body = self.cursor.peek() == Some(b'{');
        let body = if has_body { Some(Box::new(self.block()?)) } else { None };
        Some(StmtNode::Place { what, label, body })
    }

    fn expectation(&mut self) -> Option<Expect> {
        let what = self.name()?;
        let given = Box::default();
        let mut out = Expect { what, at: None, path: None, values: vec![], given };
        self.cursor.skip();
        if self.cursor.peek() == Some(b'"') {
            out.path = Some(self.string()?);
        } else {
            if self.cursor.peek() == Some(b'(') {
                out.at = Some(self.args()?);
            }
            self.cursor.equals().then_some(())?;
            out.values.push(self.expr(Place::Side)?);
            self.cursor.skip();
            let sign = ["±", "+-"]
                .into_iter()
                .find(|sign| self.cursor.rest().starts_with(sign.as_bytes()));
            if let Some(sign) = sign {
                self.cursor.at += sign.len();
                out.values.push(self.expr(Place::Side)?);
            }
        }
        if self.cursor.takes_word("where") {
            out.given = self.record()?;
        }
        Some(out)
    }
}
