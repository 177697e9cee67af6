#compdef lumen
# Completes `lumen` in zsh: eval "$(lumen completion zsh)" in ~/.zshrc, behind compinit. Where Lumen knows no word, zsh
# offers files.
_lumen() {
    local word says
    local -a found
    while IFS=$'\t' read -r word says; do
        found+=("${word//:/\\:}:$says")
    done < <(lumen completion words "${(@)words[2,CURRENT]/#/.}" 2>/dev/null)
    if (( $#found )); then
        _describe lumen found
    else
        _files
    fi
}
compdef _lumen lumen
