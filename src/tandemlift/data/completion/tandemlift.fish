function __tandemlift
    set -l words (commandline -cp)
    set -l found (env COMP_WORDS="$words" COMP_CWORD=(commandline -ct) _TANDEMLIFT_COMPLETE=fish_complete tandemlift)
    test -n "$found"; or __fish_complete_path (commandline -ct)
    string replace 'plain,' '' -- $found
end
complete --command tandemlift --no-files --arguments '(__tandemlift)'
