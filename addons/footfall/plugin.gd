@tool
extends EditorPlugin
## Footfall's entry in Project Settings → Plugins, which must name a script.
##
## There is nothing to switch on: the library registers its nodes and its file types by itself as soon as the folder is in the project.
