#compdef lineshaft
# Completion in zsh: that of bash, installed beside it.
autoload -U +X bashcompinit && bashcompinit
for folder in ${${(%):-%x}:A:h}/../../bash-completion/completions /usr/share/bash-completion/completions; do
    [[ -r $folder/lineshaft ]] && source $folder/lineshaft && break
done
