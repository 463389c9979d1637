_tandemlift() {
    local line
    COMPREPLY=()
    while IFS= read -r line; do
        COMPREPLY+=("${line#*,}")
    done < <(IFS=$'\n'; COMP_WORDS="${COMP_WORDS[*]}" COMP_CWORD=$COMP_CWORD _TANDEMLIFT_COMPLETE=bash_complete "$1")
    [[ ${COMPREPLY[0]} != *[=./] ]] || compopt -o nospace
}
complete -o nosort -o bashdefault -o default -F _tandemlift tandemlift
