// The language client of `lumen lsp`: starts it, performs the lenses' commands, and marks the active states.
"use strict";

const vscode = require("vscode");
const { LanguageClient } = require("vscode-languageclient/node");
const { commandLine } = require("./terminal");

let client;
let marks;

/** The program that answers, as the settings say. */
function command() {
  return vscode.workspace.getConfiguration("lumen").get("command");
}

/** What a lens does; what is none of ours goes to the server. */
async function execute(name, args, next) {
  if (name === "lumen.runStory") return run("test", args);
  if (name === "lumen.playMotion") return run("play", args);
  if (name === "lumen.showPlaces") return showPlaces(...args);
  return next(name, args);
}

/** Call `lumen VERB NAME` in a terminal, in the project's folder. */
function run(verb, [root, name]) {
  const terminal = vscode.window.createTerminal({ name: `Lumen: ${name}`, cwd: vscode.Uri.parse(root) });
  terminal.show(true);
  terminal.sendText(commandLine(command(), verb, name));
}

function showPlaces(uri, position, places) {
  const { asPosition, asLocation } = client.protocol2CodeConverter;
  const shown = [vscode.Uri.parse(uri), asPosition(position), places.map(asLocation)];
  return vscode.commands.executeCommand("editor.action.showReferences", ...shown);
}

/** Mark the states in which the running exhibition is, in all editors that show them. */
function mark({ places }) {
  for (const editor of vscode.window.visibleTextEditors) {
    const here = places.filter((place) => place.uri === client.code2ProtocolConverter.asUri(editor.document.uri));
    editor.setDecorations(marks, here.map((place) => client.protocol2CodeConverter.asRange(place.range)));
  }
}

async function start() {
  const [program, ...rest] = command();
  client = new LanguageClient(
    "lumen",
    "Lumen",
    { command: program, args: [...rest, "lsp", "--stdio"] },
    {
      documentSelector: [
        { scheme: "file", language: "yaml" },
        { scheme: "file", language: "json", pattern: "**/schemas/messages/*.json" },
      ],
      middleware: { executeCommand: execute },
      synchronize: { fileEvents: vscode.workspace.createFileSystemWatcher("**/*.{yaml,json,xml}") },
    },
  );
  client.onNotification("lumen/active", mark);
  await client.start();
}

async function activate(context) {
  marks = vscode.window.createTextEditorDecorationType({
    isWholeLine: true,
    backgroundColor: new vscode.ThemeColor("editor.stackFrameHighlightBackground"),
    overviewRulerColor: new vscode.ThemeColor("debugIcon.continueForeground"),
  });
  const restart = vscode.commands.registerCommand("lumen.restart", async () => {
    await deactivate();
    await start();
  });
  context.subscriptions.push(marks, restart);
  await start();
}

async function deactivate() {
  await client?.stop();
}

module.exports = { activate, deactivate };
