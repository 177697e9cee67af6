# Completes `lumen` in bash: eval "$(lumen completion bash)" in ~/.bashrc. Where Lumen knows no word, bash offers files.
_lumen() {
    local word says
    local -a words=("${COMP_WORDS[@]:1:COMP_CWORD}")
    COMPREPLY=()
    while IFS=$'\t' read -r word says; do
        COMPREPLY+=("$word")
    done < <(lumen completion words "${words[@]/#/.}" 2>/dev/null)
}
complete -o default -o bashdefault -F _lumen lumen
