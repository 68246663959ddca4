class_name PhoneCode
extends TextureRect
## Code of the page at which a phone becomes a sensor, for its camera.

var _url := ""


## Shows the code of a source's page, or nothing while it has none.
func show_page(source: PhoneImuSource) -> void:
	var url := source.get_url()
	if url == _url:
		return
	_url = url
	texture = ImageTexture.create_from_image(source.get_qr_code()) if url != "" else null
	tooltip_text = url


## Forgets the page.
func clear() -> void:
	_url = ""
	texture = null
