// What VS Code is to an extension, as far as its language client needs it: documents are opened, providers are
// registered and asked, terminals and decorations are written down. Runs the built extension against the real server.
//
//     node vscode_host.js EXTENSION PROJECT COMMAND FILE [decorated]
//
// With `decorated` it ends once states were marked.
"use strict";

const fs = require("fs");
const Module = require("module");
const path = require("path");
const { pathToFileURL, fileURLToPath } = require("url");

const [extension, project, command, file, wanted] = process.argv.slice(2);
const said = { terminals: [], shown: [], decorated: [], diagnostics: {}, lenses: [] };

class Emitter {
  constructor() {
    this.heard = [];
    this.event = (listener, that) => {
      this.heard.push(that ? listener.bind(that) : listener);
      return { dispose() {} };
    };
  }
  fire(event) {
    for (const listener of this.heard) listener(event);
  }
  dispose() {}
}
class Uri {
  constructor(text) {
    this.text = text;
    this.scheme = text.split(":")[0];
    this.path = this.scheme === "file" ? decodeURIComponent(new URL(text).pathname) : text;
    this.fsPath = this.scheme === "file" ? fileURLToPath(text) : text;
  }
  static parse(text) {
    return new Uri(text);
  }
  static file(name) {
    return new Uri(pathToFileURL(name).href);
  }
  toString() {
    return this.text;
  }
}
class Position {
  constructor(line, character) {
    Object.assign(this, { line, character });
  }
}
class Range {
  constructor(a, b, c, d) {
    this.start = typeof a === "number" ? new Position(a, b) : a;
    this.end = typeof a === "number" ? new Position(c, d) : b;
  }
}
class Location {
  constructor(uri, range) {
    Object.assign(this, { uri, range });
  }
}
class Diagnostic {
  constructor(range, message, severity) {
    Object.assign(this, { range, message, severity });
  }
}
class CodeLens {
  constructor(range, command) {
    Object.assign(this, { range, command });
  }
}
const token = { isCancellationRequested: false, onCancellationRequested: () => ({ dispose() {} }) };
class CancellationTokenSource {
  constructor() {
    this.token = token;
  }
  cancel() {}
  dispose() {}
}
class Anything {
  constructor(...given) {
    this.given = given;
  }
  dispose() {}
}

const opened = new Emitter();
const text = fs.readFileSync(file, "utf8");
const document = {
  uri: Uri.file(file),
  fileName: file,
  languageId: "yaml",
  version: 1,
  isClosed: false,
  isDirty: false,
  getText: () => text,
};
const editor = { document, setDecorations: (_, ranges) => said.decorated.push(ranges.map((range) => range.start.line)) };
const commands = new Map();
const lensProviders = [];
const nothing = () => ({ dispose() {} });

/** An object with these members; any other is a function that registers something, an event, or a class. */
function api(members) {
  return new Proxy(members, {
    get: (target, name) => (name in target || typeof name === "symbol" ? target[name] : /^[A-Z]/.test(name) ? Anything : nothing),
  });
}

const vscode = api({
  EventEmitter: Emitter, Uri, Position, Range, Location, Diagnostic, CodeLens, CancellationTokenSource,
  version: "1.82.0",
  env: api({ appName: "host", language: "en" }),
  DiagnosticSeverity: { Error: 0, Warning: 1, Information: 2, Hint: 3 },
  CodeActionKind: Object.assign(Object.fromEntries(["QuickFix", "Refactor", "Source"].map((kind) => [kind, {}])), {
    Empty: { append: (kind) => ({ kind }) },
  }),
  FileType: { File: 1, Directory: 2 },
  ExtensionMode: { Production: 1, Test: 3 },
  workspace: api({
    textDocuments: [document],
    notebookDocuments: [],
    workspaceFolders: [{ uri: Uri.file(project), name: "project", index: 0 }],
    getConfiguration: () => ({ get: (key, otherwise) => (key === "command" ? JSON.parse(command) : otherwise) }),
    onDidOpenTextDocument: opened.event,
    getWorkspaceFolder: () => undefined,
    createFileSystemWatcher: () => api({ dispose() {}, onDidCreate: nothing, onDidChange: nothing, onDidDelete: nothing }),
  }),
  window: api({
    visibleTextEditors: [editor],
    activeTextEditor: editor,
    tabGroups: api({ all: [] }),
    createOutputChannel: () => api({ append() {}, appendLine() {}, show() {}, dispose() {} }),
    createTextEditorDecorationType: () => new Anything(),
    createTerminal: (options) => ({ show() {}, sendText: (line) => said.terminals.push([options.cwd.fsPath, line]) }),
    showErrorMessage: async (message) => console.error(message),
    showInformationMessage: async () => undefined,
    showWarningMessage: async () => undefined,
  }),
  languages: api({
    match: () => 10,
    createDiagnosticCollection: () =>
      api({
        set: (uri, found) => (said.diagnostics[uri.toString()] = found.map((each) => each.message)),
        delete() {},
        clear() {},
        dispose() {},
      }),
    registerCodeLensProvider: (_, provider) => (lensProviders.push(provider), new Anything()),
  }),
  commands: api({
    registerCommand: (name, act) => (commands.set(name, act), new Anything()),
    executeCommand: async (name, ...args) => said.shown.push([name, args[2].length]),
  }),
});

const load = Module._load;
Module._load = (name, ...more) => (name === "vscode" ? vscode : load(name, ...more));

async function main() {
  const { activate, deactivate } = require(path.resolve(extension));
  const context = { subscriptions: [], extensionPath: extension };
  await activate(context);
  for (let left = 600; left && !lensProviders.length; left--) await new Promise((done) => setTimeout(done, 50));
  for (const provider of lensProviders) said.lenses.push(...((await provider.provideCodeLenses(document, token)) ?? []));
  said.lenses = said.lenses.map((each) => each.command);
  const first = (name) => said.lenses.find((each) => each.command === name);
  for (const name of ["lumen.runStory", "lumen.playMotion", "lumen.showPlaces"]) {
    const lens = first(name);
    if (lens) await commands.get(name)(...lens.arguments);
  }
  for (let left = 600; wanted && left && !said.decorated.some((lines) => lines.length); left--) {
    await new Promise((done) => setTimeout(done, 50));
  }
  await deactivate();
  said.commands = [...commands.keys()];
  fs.writeSync(1, JSON.stringify(said));
  process.exit(0);
}

main().catch((error) => {
  console.error(error);
  process.exit(1);
});
