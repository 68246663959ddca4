@tool
extends EditorPlugin
## Footfall's entry in Project Settings → Plugins, which must name a script.
##
## There is nothing to enable: the library registers its nodes and file types as soon as the folder is in the project.
