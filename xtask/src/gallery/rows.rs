//! What hangs in the gallery.

/// A picture.
#[derive(Debug, Clone, Copy)]
pub(super) struct Entry {
    /// Of its files
    pub(super) name: &'static str,
    /// In `scenes/`
    pub(super) scene: &'static str,
    /// Samples a pixel, of which a call can take more
    pub(super) spp: u32,
    /// How its light is taken apart
    pub(super) layers: Layers,
    /// Further arguments of `tyndall render`
    pub(super) options: &'static [&'static str],
    /// Of its section
    pub(super) title: &'static str,
    /// What to look at; a paragraph of Markdown
    pub(super) caption: &'static str,
}

/// How the light of a picture is taken apart.
#[derive(Debug, Clone, Copy)]
pub(super) enum Layers {
    /// By surfaces and media, by media, by media in detail
    Media,
    /// By surfaces, where there are no media that scatter: in the whole and in detail
    Surfaces,
}

impl Layers {
    /// For `tyndall render --layers`.
    pub(super) fn list(self) -> &'static str {
        match self {
            Self::Media => "emission,direct,indirect,unscattered,single,multiple,orders:4",
            Self::Surfaces => "emission,direct,indirect,depths:4",
        }
    }

    /// What `tyndall layers --strips` calls the groups of these.
    pub(super) fn groups(self) -> &'static [&'static str] {
        match self {
            Self::Media => &["ways", "media", "orders"],
            Self::Surfaces => &["ways", "depths"],
        }
    }
}

/// All of them, in the order of the page.
pub(super) const ENTRIES: [Entry; 13] = [
    Entry {
        name: "milk",
        scene: "milk/scene.pbrt",
        spp: 512,
        layers: Layers::Media,
        options: &["--seed", "1"],
        title: "A glass of milk",
        caption: "Milk is white because light collides about two hundred times in it: what has collided once is three \
                  hundredths of the light. The side is creamier than the top, and where the milk touches the glass there is \
                  no air between them.",
    },
    Entry {
        name: "glasses",
        scene: "glasses/scene.pbrt",
        spp: 320,
        layers: Layers::Media,
        options: &[],
        title: "Whole milk and skimmed milk",
        caption: "Both are mixed from their recipe: 3.5 % of fat on the left, 0.1 % on the right, with nearly the same protein. \
                  Skimmed milk is greener, for light gets deeper into it and meets more riboflavin. Nearly all of the once \
                  scattered light is its: casein micelles scatter to all sides, globules of fat forwards.",
    },
    Entry {
        name: "marble-beam",
        scene: "marble/beam.pbrt",
        spp: 1024,
        layers: Layers::Media,
        options: &[],
        title: "Marble under a beam",
        caption: "A cube of 40 mm. The beam is 20 mm wide and meets one face near an edge: light spreads in the stone and comes \
                  out around the spot and on the other faces.",
    },
    Entry {
        name: "marble-soft",
        scene: "marble/soft.pbrt",
        spp: 768,
        layers: Layers::Media,
        options: &[],
        title: "Marble under soft light",
        caption: "The same cube under a large lamp: edges glow, and the shaded face is not dark, for light comes through.",
    },
    Entry {
        name: "marble-figure",
        scene: "marble/figure.pbrt",
        spp: 256,
        layers: Layers::Media,
        options: &[],
        title: "A figure of marble",
        caption: "A veiled head, 153 mm high. A warm lamp stands behind it, and the veil, four millimetres thick, lets its light \
                  through, red more than blue; head and plinth let none. Shadows on the face are soft, for the stone fills them.",
    },
    Entry {
        name: "fog",
        scene: "fog/scene.pbrt",
        spp: 1200,
        layers: Layers::Media,
        options: &[],
        title: "Shafts of light",
        caption: "Sun through four tall windows into a hall full of fog. The shafts are light that the fog has scattered once; \
                  the haze around them has been scattered more often.",
    },
    Entry {
        name: "cornell-empty",
        scene: "cornell/empty.pbrt",
        spp: 64,
        layers: Layers::Media,
        options: &[],
        title: "Cornell box, empty",
        caption: "Nothing scatters but walls, so all light is of order 0 in media, and the colours of the walls are on the \
                  blocks by indirect light.",
    },
    Entry {
        name: "cornell-foggy",
        scene: "cornell/foggy.pbrt",
        spp: 768,
        layers: Layers::Media,
        options: &[],
        title: "Cornell box, foggy",
        caption: "Fog with a mean free path as long as the room: the lamp has a halo of light that was scattered once, and \
                  shadows fill.",
    },
    Entry {
        name: "cornell-milky",
        scene: "cornell/milky.pbrt",
        spp: 1600,
        layers: Layers::Media,
        options: &[],
        title: "Cornell box, milky",
        caption: "Thin milk: the near block is a shade, the far one is gone, and of the walls a tint is left.",
    },
    Entry {
        name: "hair",
        scene: "hair/scene.pbrt",
        spp: 256,
        layers: Layers::Surfaces,
        options: &[],
        title: "Blond hair and dark hair",
        caption: "A fibre of blond hair is nearly clear; its colour is that of many of them, of light that was scattered more than once. \
                  There are no media here: see [Hair](hair.md).",
    },
    Entry {
        name: "hair-head",
        scene: "hair/head.pbrt",
        spp: 384,
        layers: Layers::Surfaces,
        options: &[],
        title: "Two heads of hair",
        caption: "16,000 strands each, combed back. Round a head shine lies in bands, for strands beside each other turn the same way to \
                  the lamp. Blond hair is golden by what was scattered more than once: most of its red, and the smaller part of its blue. \
                  The lamp behind shines through the edge of it.",
    },
    Entry {
        name: "beads",
        scene: "grains/beads.pbrt",
        spp: 512,
        layers: Layers::Surfaces,
        options: &[],
        title: "A heap of glass beads",
        caption: "399 balls of green window glass that were poured and have come to rest. Each bends light at its faces and absorbs a \
                  little of its red, so that the heap is darker and greener the deeper one looks into it.",
    },
    Entry {
        name: "grains",
        scene: "grains/scene.pbrt",
        spp: 512,
        layers: Layers::Surfaces,
        options: &[],
        title: "Sugar, salt and snow",
        caption: "Every grain is as clear as glass; the heaps are white because light meets one face after the other before it comes \
                  out. Sugar bends it most (1.558), salt less (1.544), ice least (1.31), so light gets deepest into the snow, \
                  which is the least bright of the three.",
    },
];
