//! What a file looks like: its folds, colours of tokens and colours themselves.

use std::ops::Range;

use luxel_lang::editor::{self, Colour, Coloured, Document, coloured, folds, swatches};
use serde_json::{Value, json};

use super::server::Server;
use super::wire::{Code, Refusal};

/// The protocol's words for what tokens are, in the order of `index`.
pub(super) const LEGEND: [&str; 13] = [
    "keyword",
    "type",
    "class",
    "property",
    "variable",
    "parameter",
    "function",
    "namespace",
    "enumMember",
    "number",
    "string",
    "comment",
    "decorator",
];

/// Bytes of a file whose tokens are all told at once, at most; a client asks for parts of larger ones.
const WHOLE: usize = 2 << 20;

fn index(colour: Colour) -> usize {
    match colour {
        Colour::Keyword => 0,
        Colour::Type => 1,
        Colour::Class => 2,
        Colour::Property => 3,
        Colour::Variable => 4,
        Colour::Parameter => 5,
        Colour::Function => 6,
        Colour::Namespace => 7,
        Colour::Unit => 8,
        Colour::Number => 9,
        Colour::Text => 10,
        Colour::Doc => 11,
        Colour::Attribute => 12,
    }
}

impl Server {
    pub(super) fn folding(
        &self,
        params: &Value,
        stop: &dyn Fn() -> bool,
    ) -> Result<Value, Refusal> {
        let (_, document) = self.asked(params)?;
        let one = |fold: &editor::Fold| {
            let mut out = json!({ "startLine": fold.start, "endLine": fold.end });
            if fold.is_comment {
                out["kind"] = json!("comment");
            }
            out
        };
        Ok(folds(&document, stop).iter().map(one).collect())
    }

    pub(super) fn tokens(&self, params: &Value, stop: &dyn Fn() -> bool) -> Result<Value, Refusal> {
        let (_, document) = self.asked(params)?;
        let range = match params.get("range") {
            Some(_) => self.asked_range(&document, params)?,
            None if document.text().len() > WHOLE => return Ok(Value::Null),
            None => 0..document.text().len(),
        };
        let mut data: Vec<usize> = vec![];
        let mut last = (0, 0);
        for token in coloured(&document, &range, stop) {
            for part in lines(&document, &token) {
                let (line, column) = self.encoding.place(&document, part.start);
                let length = self.encoding.width(&document.text()[part]);
                let before = if line == last.0 { last.1 } else { 0 };
                let modifiers =
                    usize::from(token.is_definition) + 2 * usize::from(token.colour == Colour::Doc);
                data.extend([
                    line - last.0,
                    column - before,
                    length,
                    index(token.colour),
                    modifiers,
                ]);
                last = (line, column);
            }
        }
        Ok(json!({ "data": data }))
    }

    pub(super) fn colours(
        &self,
        params: &Value,
        stop: &dyn Fn() -> bool,
    ) -> Result<Value, Refusal> {
        let (_, document) = self.asked(params)?;
        let one = |swatch: &editor::Swatch| {
            let [red, green, blue] = swatch.srgb;
            json!({
                "range": self.encoding.range(&document, &swatch.range),
                "color": { "red": red, "green": green, "blue": blue, "alpha": 1.0 },
            })
        };
        Ok(swatches(&document, stop).iter().map(one).collect())
    }

    pub(super) fn presentation(&self, params: &Value) -> Result<Value, Refusal> {
        let (_, document) = self.asked(params)?;
        let range = self.asked_range(&document, params)?;
        let channel = |name: &str| params["color"][name].as_f64();
        let (Some(r), Some(g), Some(b)) = (channel("red"), channel("green"), channel("blue"))
        else {
            let why = "`color` wants `red`, `green` and `blue`";
            return Err(Refusal::new(Code::InvalidParams, why));
        };
        let forms = editor::written(&document.text()[range], [r, g, b]);
        Ok(forms.iter().map(|form| json!({ "label": form })).collect())
    }
}

/// The parts of a token by lines: few clients take tokens of several.
fn lines(document: &Document, token: &Coloured) -> Vec<Range<usize>> {
    let (first, last) = (document.line_of(token.range.start), document.line_of(token.range.end));
    let part = |line: usize| {
        let whole = document.line(line);
        whole.start.max(token.range.start)..whole.end.min(token.range.end)
    };
    (first..=last).map(part).filter(|part| part.start < part.end).collect()
}
