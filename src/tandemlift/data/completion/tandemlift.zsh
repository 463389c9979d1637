#compdef tandemlift
_tandemlift() {
    local -a answer found joined
    local kind word meaning
    answer=("${(@f)$(COMP_WORDS="$words" COMP_CWORD=$((CURRENT - 1)) _TANDEMLIFT_COMPLETE=zsh_complete $words[1])}")
    [[ -n $answer ]] || { _files; return }
    for kind word meaning in $answer; do
        [[ $word != *[=./] ]] || joined=(-S '')
        [[ $meaning == _ ]] && found+=("$word") || found+=("$word:$meaning")
    done
    _describe -V tandemlift found -U $joined
}
if [[ $zsh_eval_context[-1] == loadautofunc ]]; then _tandemlift "$@"; else compdef _tandemlift tandemlift; fi
