"""The scripts by which bash, zsh and fish complete the words of the command line.

Each asks the program itself, by click's protocol: it calls it with the words so far in the environment. No space
follows a word that goes on, and where the program knows no word, the shell's own names of files are offered.
"""

BASH = r"""_tandemlift() {
    local line
    COMPREPLY=()
    while IFS= read -r line; do
        COMPREPLY+=("${line#*,}")
    done < <(IFS=$'\n'; COMP_WORDS="${COMP_WORDS[*]}" COMP_CWORD=$COMP_CWORD _TANDEMLIFT_COMPLETE=bash_complete "$1")
    [[ ${COMPREPLY[0]} != *[=./] ]] || compopt -o nospace
}
complete -o nosort -o bashdefault -o default -F _tandemlift tandemlift
"""

ZSH = r"""#compdef tandemlift
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
"""

FISH = r"""function __tandemlift
    set -l words (commandline -cp)
    set -l found (env COMP_WORDS="$words" COMP_CWORD=(commandline -ct) _TANDEMLIFT_COMPLETE=fish_complete tandemlift)
    test -n "$found"; or __fish_complete_path (commandline -ct)
    string replace 'plain,' '' -- $found
end
complete --command tandemlift --no-files --arguments '(__tandemlift)'
"""

SCRIPTS = {"bash": BASH, "zsh": ZSH, "fish": FISH}
