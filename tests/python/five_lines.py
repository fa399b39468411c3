import catoptric

scene = catoptric.load("cornell-mirrors")
table = catoptric.compare(scene, ["reuse", "parallax", "secant"], size=(128, 128))
print(table)
