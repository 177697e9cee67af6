# Completes `lumen` in fish: lumen completion fish > ~/.config/fish/completions/lumen.fish. Where Lumen knows no word, fish
# offers files.
function __lumen_complete
    set -l words (commandline -opc)
    set -e words[1]
    set -l token (commandline -ct)
    set words $words "$token"
    set -l found (lumen completion words .$words 2>/dev/null)
    if test (count $found) -gt 0
        printf '%s\n' $found
    else
        __fish_complete_path (commandline -ct)
    end
end
complete -c lumen -f -a '(__lumen_complete)'
