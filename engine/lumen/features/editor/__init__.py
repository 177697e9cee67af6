"""The language server for editors."""

from lumen.feature import EditorRow, Feature, Subcommand

_ANSWERS = "lumen.features.editor.requests"

FEATURE = Feature(
    name="editor",
    subcommands={
        "lsp": Subcommand(
            "run the language server for editors (LSP)", "lumen.features.editor.command", after="completion"
        )
    },
    editor_requests={
        "textDocument/didOpen": EditorRow(f"{_ANSWERS}.sync:opened"),
        "textDocument/didChange": EditorRow(f"{_ANSWERS}.sync:changed"),
        "textDocument/didSave": EditorRow(f"{_ANSWERS}.sync:saved"),
        "textDocument/didClose": EditorRow(f"{_ANSWERS}.sync:closed"),
        "workspace/didChangeWatchedFiles": EditorRow(f"{_ANSWERS}.sync:touched"),
        "textDocument/completion": EditorRow(f"{_ANSWERS}.positions:complete", f"{_ANSWERS}.positions:TRIGGERS"),
        "textDocument/hover": EditorRow(f"{_ANSWERS}.positions:show"),
        "textDocument/definition": EditorRow(f"{_ANSWERS}.positions:define"),
        "textDocument/references": EditorRow(f"{_ANSWERS}.positions:refer"),
        "textDocument/documentHighlight": EditorRow(f"{_ANSWERS}.positions:highlight"),
        "textDocument/prepareRename": EditorRow(f"{_ANSWERS}.changes:prepare"),
        "textDocument/rename": EditorRow(f"{_ANSWERS}.changes:rename", f"{_ANSWERS}.changes:RENAMING"),
        "textDocument/codeAction": EditorRow(f"{_ANSWERS}.changes:repair", f"{_ANSWERS}.changes:REPAIRS"),
        "textDocument/documentSymbol": EditorRow(f"{_ANSWERS}.outlines:outline"),
        "workspace/symbol": EditorRow(f"{_ANSWERS}.outlines:search"),
        "textDocument/foldingRange": EditorRow(f"{_ANSWERS}.outlines:fold"),
        "textDocument/documentLink": EditorRow(f"{_ANSWERS}.outlines:link"),
        "textDocument/codeLens": EditorRow(f"{_ANSWERS}.annotations:lens"),
        "textDocument/inlayHint": EditorRow(f"{_ANSWERS}.annotations:hint"),
        "textDocument/signatureHelp": EditorRow(f"{_ANSWERS}.annotations:call", f"{_ANSWERS}.annotations:CALLS"),
        "initialized": EditorRow(f"{_ANSWERS}.sync:begun"),
        "shutdown": EditorRow(f"{_ANSWERS}.sync:ended"),
    },
    editor_commands={
        "lumen.runStory": f"{_ANSWERS}.commands:run_story",
        "lumen.playMotion": f"{_ANSWERS}.commands:play_motion",
        "lumen.showPlaces": f"{_ANSWERS}.commands:show_places",
    },
)
