-- Drives `luxel lsp` with Neovim without a window: LUXEL=target/debug/luxel nvim --headless -u NONE -l
-- needs 0.9; of 0.7 on: LUXEL=... nvim --headless -u NONE -c "luafile tests/editors/nvim.lua"
-- Ends with code 0 and `fine`, else with 1 and what went wrong.
local program = os.getenv("LUXEL") or "luxel"
local folder = vim.fn.tempname()
vim.fn.mkdir(folder, "p")
local path = folder .. "/a é.scene"
local text = {
  "scene 1",
  'let é = 1',
  "let gold = material conductor { eta = metal(\"Au\") }",
  "shape sphere \"ball\" {",
  "  radius = 1 m",
  "  material = gld",
  "}",
}
vim.fn.writefile(text, path)

local function fail(what)
  io.stderr:write("wrong: " .. what .. "\n")
  vim.cmd("cquit 1")
end
local function check(holds, what)
  if not holds then fail(what) end
end

vim.cmd("edit " .. vim.fn.fnameescape(path))
local buffer = vim.api.nvim_get_current_buf()
local client = vim.lsp.start_client({ name = "luxel", cmd = { program, "lsp" }, root_dir = folder })
vim.lsp.buf_attach_client(buffer, client)
local function found() return vim.diagnostic.get(buffer) end
local function has(code)
  for _, told in ipairs(found()) do
    if told.code == code then return told end
  end
end
check(vim.wait(10000, function() return has("E0101") end), "no E0101: " .. vim.inspect(found()))
local told = has("E0101")
check(told.lnum == 5 and told.col == 13 and told.end_col == 16, vim.inspect(told))

local function ask(method, line, column, more)
  local params = { textDocument = vim.lsp.util.make_text_document_params(buffer),
    position = { line = line, character = column } }
  for key, value in pairs(more or {}) do params[key] = value end
  local answers, why = vim.lsp.buf_request_sync(buffer, method, params, 10000)
  check(answers and answers[client] and answers[client].result, method .. ": " .. vim.inspect(answers or why))
  return answers[client].result
end

local hover = ask("textDocument/hover", 4, 4)
check(hover.contents.value:find("radius: number, in m"), vim.inspect(hover))
local list = ask("textDocument/completion", 5, 13)
local labels = {}
for _, item in ipairs(list.items) do labels[item.label] = true end
check(labels.gold and not labels.ball, vim.inspect(labels))

-- The mend, as a person would take it.
local actions = ask("textDocument/codeAction", 5, 14, {
  range = { start = { line = 5, character = 13 }, ["end"] = { line = 5, character = 16 } },
  context = { diagnostics = {} },
})
vim.lsp.util.apply_workspace_edit(actions[1].edit, "utf-16")
check(vim.api.nvim_buf_get_lines(buffer, 5, 6, true)[1] == "  material = gold", "the mend")
check(vim.wait(10000, function() return not has("E0101") end), "E0101 stays")

local edits = ask("textDocument/rename", 5, 14, { newName = "shiny" })
vim.lsp.util.apply_workspace_edit(edits, "utf-16")
local lines = vim.api.nvim_buf_get_lines(buffer, 0, -1, true)
check(lines[3]:find("let shiny") and lines[6] == "  material = shiny", vim.inspect(lines))
check(#ask("textDocument/documentSymbol", 0, 0) >= 2, "the outline")

vim.lsp.stop_client(client)
check(vim.wait(10000, function() return vim.lsp.client_is_stopped(client) end), "it does not end")
print("fine\n")
vim.cmd("qall!")
